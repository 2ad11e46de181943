//! Runs that are told the states of a lane.

use dalembert::nalgebra::{SVector, vector};
use dalembert::run::events::{Watch, Watched};
use dalembert::run::{LaneRuns, Run, ToldRun};
use dalembert::{Discretise, Splitting, State};

use super::systems::Ring;

/// A run that is told the states of a lane has the events of its own run, and ends where that does.
#[test]
fn a_run_that_is_told_its_states_is_watched_as_its_own() {
    let (ring, method, h) = (Ring { k: 0.01, height: 1.0 }, Splitting::blanes_moan_6(), 0.2);
    let start = State { q: vector![0.3, 1.0], p: vector![0.5, -0.1] };
    let radius = |q: &SVector<f64, 2>| q.norm() - 1.0;
    for end in [57.0, 57.31] {
        let mut own = ring.by(method, h).run(start);
        let mut watch = own.watch(|at| [radius(&at.q)]).until(end);
        let mut expected = Vec::new();
        while let Some(item) = watch.advance() {
            let time = watch.run().time();
            expected.push(match item.unwrap() {
                Watched::Event(event) => (event.time, event.state, true),
                Watched::Step(step) => (time, step.state, false),
            });
        }
        let mut lanes = LaneRuns::new(method, [&ring; 2], &[start; 2], h);
        let mut told = ToldRun::new(method, &ring, start, h);
        let mut watch = Watch::new(&mut told, |at| [radius(&at.q)]).until(end);
        let mut found = Vec::new();
        'run: loop {
            lanes.advance(1);
            watch.run().tell(lanes.state(1).unwrap());
            loop {
                let item = watch.advance();
                let time = watch.run().time();
                match item {
                    Some(Ok(Watched::Event(event))) => found.push((event.time, event.state, true)),
                    Some(Ok(Watched::Step(step))) => {
                        found.push((time, step.state, false));
                        if time == end {
                            break 'run;
                        }
                        break;
                    }
                    Some(Err(error)) => panic!("{error}"),
                    None => break 'run,
                }
            }
        }
        assert!(expected.iter().filter(|item| item.2).count() > 3, "{expected:?}");
        assert_eq!(expected.len(), found.len(), "{:?} {:?}", expected.last(), found.last());
        for (found, expected) in found.iter().zip(&expected) {
            let off = (found.0 - expected.0).abs().max((found.1.q - expected.1.q).amax());
            assert!(found.2 == expected.2 && off < 1e-13, "{found:?} {expected:?}");
        }
        assert_eq!(found.last().unwrap().0, end);
        // The control: a lane of another ring has other events.
        let mut lanes = LaneRuns::new(method, [&Ring { k: 0.01, height: 1.5 }; 2], &[start; 2], h);
        lanes.advance(1);
        assert!((lanes.state(1).unwrap().q - found[0].1.q).amax() > 1e-4);
    }
}
