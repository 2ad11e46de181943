// The scenes: where they start, what their controls reach, and what is drawn of a state.
//
// `ranges`: sliders go from the least to the most in equal ratios; with `zero` their left end is 0.
// `span`: how much time the charts begin with. `widest`: a curve that leaves this is cut off.
// `rule`: the one that the scene begins with. `isChaotic`: two methods soon show different motions.
// `points`: what is drawn of q, joined, the last one with the way behind it; within `reach` of the middle.

const ring = {
    name: "ring",
    about: "A particle in the potential s(s − 1)², s = |q|², with drag; all quantities are dimensionless.",
    parameters: { friction: 1e-3 },
    start: { q: [0, 1.15549918674982], v: [0.5, 0] },
    rule: "midpoint",
    isChaotic: false,
    h: 0.2,
    speed: 100,
    ranges: {
        friction: { least: 1e-4, most: 1e-1, zero: true, unit: "" },
        h: { least: 0.02, most: 0.5, unit: "" },
        speed: { least: 1, most: 1000, unit: "units of t a second" },
    },
    span: 50,
    time: "time t",
    energy: { title: "Energy E (dimensionless)", widest: [-0.05, 0.6] },
    momentum: { title: "Angular momentum J = q × p (dimensionless)", widest: [-1, 1] },
    angularMomentum: ([q, p]) => q[0] * p[1] - q[1] * p[0],
    reach: 1.45,
    points: (q) => [q],
    // The bottom of the valley, and the crest around the middle.
    circles: [1, Math.sqrt(1 / 3)],
};

const doublePendulum = {
    name: "double_pendulum",
    about: "Two masses of 1 kg on rods of 1 m, with the same friction in both joints. Without friction the energy is constant, without gravity the angular momentum too. The motion is chaotic.",
    parameters: { friction: 0, gravity: 9.81 },
    start: { q: [2, 2.5], v: [0, 0] },
    // Its energy swings by some 1e-4 J where that of the rules of order 2 has spikes.
    rule: "gauss",
    isChaotic: true,
    h: 0.02,
    speed: 10,
    ranges: {
        friction: { least: 1e-3, most: 1, zero: true, unit: "N m s" },
        gravity: { least: 0.1, most: 20, zero: true, unit: "m/s²" },
        h: { least: 0.002, most: 0.1, unit: "s" },
        speed: { least: 0.1, most: 100, unit: "times real time" },
    },
    span: 10,
    time: "time t (s)",
    energy: { title: "Energy E (J)", widest: [-60, 120] },
    momentum: { title: "Angular momentum about the hinge, p₁ + p₂ (J s)", widest: [-60, 60] },
    angularMomentum: ([, p]) => p[0] + p[1],
    reach: 2.15,
    circles: [],
    points: (q) => {
        const elbow = [Math.sin(q[0]), -Math.cos(q[0])];
        return [[0, 0], elbow, [elbow[0] + Math.sin(q[1]), elbow[1] - Math.cos(q[1])]];
    },
};

export const scenes = { ring, double_pendulum: doublePendulum };
