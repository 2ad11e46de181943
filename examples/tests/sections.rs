//! What the scenes `poincare`, `bouncing` and `backlash` claim, against computations that share no code with
//! them.

#[path = "../examples/backlash.rs"]
#[expect(dead_code, reason = "of the scene, what it computes is tested here, not what it prints")]
mod backlash;
#[path = "../examples/bouncing.rs"]
#[expect(dead_code, reason = "of the scene, what it computes is tested here, not what it prints")]
mod bouncing;
#[path = "../examples/poincare.rs"]
#[expect(dead_code, reason = "of the scene, what it computes is tested here, not what it prints")]
mod poincare;

use bouncing::{IMPACTS, STOP};
use nalgebra::Vector4;
use poincare::{ENERGIES, ORBITS};

/// One step of the classical Runge–Kutta method of Hénon and Heiles' equations, written by hand.
fn runge_kutta(z: &Vector4<f64>, h: f64) -> Vector4<f64> {
    let rate = |z: &Vector4<f64>| {
        Vector4::new(z[2], z[3], -z[0] - 2.0 * z[0] * z[1], -z[1] - z[0] * z[0] + z[1] * z[1])
    };
    let a = rate(z);
    let b = rate(&(z + a * (0.5 * h)));
    let c = rate(&(z + b * (0.5 * h)));
    let d = rate(&(z + c * h));
    z + (a + (b + c) * 2.0 + d) * (h / 6.0)
}

#[test]
fn sections_are_those_of_another_method() {
    for (_, energy) in ENERGIES {
        let start = poincare::starts(energy)[ORBITS / 3];
        let orbit = poincare::orbit(&start, 5).unwrap();
        assert!(orbit.off[0] < 1e-13 && orbit.off[1] < 1e-13, "{:?}", orbit.off);
        let (mut z, h) = (Vector4::new(start.q[0], start.q[1], start.p[0], start.p[1]), 1.0 / 512.0);
        let mut points = orbit.points.iter();
        let mut passed = 0;
        while passed < 5 {
            let next = runge_kutta(&z, h);
            if z[0] < 0.0 && next[0] >= 0.0 {
                let (mut low, mut high) = (0.0, h);
                for _ in 0..50 {
                    let middle = 0.5 * (low + high);
                    *(if runge_kutta(&z, middle)[0] < 0.0 { &mut low } else { &mut high }) = middle;
                }
                let [y, p] = *points.next().unwrap();
                let found = runge_kutta(&z, low);
                assert!(
                    (found[1] - y).abs() < 1e-7 && (found[3] - p).abs() < 1e-7,
                    "{passed} {found} {y} {p}"
                );
                passed += 1;
            }
            z = next;
        }
    }
}

/// Hénon and Heiles' finding: order at 1/12, and chaos nearly everywhere at 1/6.
#[test]
#[cfg_attr(debug_assertions, ignore = "long without optimisation: cargo test --release")]
fn order_gives_way_to_chaos() {
    let chaotic = ENERGIES.map(|(_, energy)| {
        let orbits = poincare::section(energy, 600).unwrap();
        orbits.iter().filter(|orbit| orbit.is_chaotic()).count()
    });
    assert_eq!(chaotic[0], 0, "{chaotic:?}");
    assert!(chaotic[1] > ORBITS / 8 && chaotic[1] < ORBITS * 3 / 4, "{chaotic:?}");
    assert!(chaotic[2] > ORBITS * 2 / 3, "{chaotic:?}");
}

/// The account closes at all times, and the impacts are on the stop.
#[test]
fn the_account_of_a_bouncing_pendulum_closes() {
    let bouncing = bouncing::bounce().unwrap();
    assert!(bouncing.remainder < 1e-13, "{}", bouncing.remainder);
    assert_eq!(bouncing.impacts.len(), IMPACTS);
    assert!(bouncing.accounts.iter().all(|account| account.angle > STOP - 1e-15));
    let last = bouncing.accounts.last().unwrap();
    assert!(last.taken[1] > 0.3 && last.taken[0] > 0.01 && last.energy < 0.2);
}

/// The load never passes the stop, and rests on it while the motor presses, wound up by as much as the teeth
/// give; the first impact is that of Runge–Kutta steps of a microsecond.
#[test]
fn a_load_pressed_on_its_stop_stays_there_until_it_is_pulled_away() {
    let motion = backlash::drive().unwrap();
    assert!(motion.angles.iter().all(|(_, [_, load])| *load <= backlash::STOP + 1e-14));
    let held: Vec<f64> = motion
        .angles
        .iter()
        .filter(|(time, _)| (0.7..backlash::TURNS).contains(time))
        .map(|(_, [motor, load])| {
            assert_eq!(*load, backlash::STOP);
            *motor
        })
        .collect();
    let mean = held.iter().sum::<f64>() / held.len() as f64;
    let still = backlash::STOP + backlash::PLAY + backlash::TORQUE / backlash::STIFFNESS;
    assert!((mean - still).abs() < 2e-5, "{mean} {still}");
    assert!(motion.releases.last().unwrap() > &backlash::TURNS);

    // (q0, q1, v0, v1) by hand.
    let rate = |z: &Vector4<f64>| {
        let by = z[0] - z[1];
        let tooth = backlash::STIFFNESS * (by - by.clamp(-backlash::PLAY, backlash::PLAY));
        Vector4::new(
            z[2],
            z[3],
            (backlash::TORQUE - 2e-3 * z[2] - tooth) / 2e-4,
            (tooth - 4e-3 * z[3]) / 1e-3,
        )
    };
    let (mut z, mut time, h) = (Vector4::new(backlash::PLAY, 0.0, 0.0, 0.0), 0.0, 1e-6);
    while z[1] < backlash::STOP {
        let a = rate(&z);
        let b = rate(&(z + a * (0.5 * h)));
        let c = rate(&(z + b * (0.5 * h)));
        let d = rate(&(z + c * h));
        z += (a + (b + c) * 2.0 + d) * (h / 6.0);
        time += h;
    }
    time -= (z[1] - backlash::STOP) / z[3];
    // Corners of the force leave its order.
    assert!((motion.impacts[0] - time).abs() < 2e-5, "{} {time}", motion.impacts[0]);
}
