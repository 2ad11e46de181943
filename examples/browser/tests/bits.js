// The runs of src/host/runs.rs by the module, in its lines.

import { Module } from "./module.js";
import { RuleRun, RungeKuttaRun } from "./runs.js";
import { scenes } from "./scenes.js";

const [STEPS, MORE] = [2500, 100];
const CHANGED = { ring: { friction: 1e-2 }, double_pendulum: { friction: 0.1, gravity: 9.81 } };
const PARTS = { midpoint: 1, trapezoidal: 1, gauss: 1, reference: 4, runge_kutta: 1 };

function bits(number) {
    const view = new DataView(new ArrayBuffer(8));
    view.setFloat64(0, number);
    return view.getBigUint64(0).toString(16).padStart(16, "0");
}

function* lines(module, scene, method, nudge) {
    const { name, parameters, start: { q, v } } = scene;
    const h = (scene.h / PARTS[method]) * (1 + nudge);
    const run =
        method === "runge_kutta"
            ? new RungeKuttaRun(module, `${name}_${method}`, `${name}_midpoint`, parameters, h, q, v)
            : new RuleRun(module, `${name}_${method}`, parameters, h, q, v);
    for (let step = 1; step <= STEPS + 2 * MORE; step++) {
        if (step === STEPS + 1) run.changeParameters(CHANGED[name]);
        if (step === STEPS + MORE + 1) run.changeStepSize(0.5 * h);
        run.step();
        const [q, p] = run.state;
        yield `${name}_${method} ${step} ${[...q, ...p, run.energy].map(bits).join(" ")}\n`;
    }
}

// All of them; with a `nudge` the step size is longer by this share.
export async function all(nudge = 0) {
    const module = await Module.load("live.wasm");
    const runs = Object.values(scenes).flatMap((scene) => Object.keys(PARTS).map((method) => [scene, method]));
    return runs.flatMap(([scene, method]) => [...lines(module, scene, method, nudge)]).join("");
}
