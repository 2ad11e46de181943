// The same motion by a rule, by RK4 with the same step size or at the same cost, and by a reference.

import { History } from "./history.js";
import { RuleRun, RungeKuttaRun } from "./runs.js";

// The reference: the Gauss rule of 4 stages, of order 8, with a quarter of the step.
const PARTS = 4;
// States behind the present one that are drawn.
const TRAIL = 300;
// The distance of a coordinate from the reference's, in rad or units of length, from which two motions are said to have parted.
const APART = 1;

class Course {
    constructor(scene, run, parts) {
        Object.assign(this, { scene, run, parts, trail: [], failure: null, parted: null });
        this.energy = new History(scene.span);
        this.momentum = new History(scene.span);
        this.look(0);
    }

    // Notes the present state.
    look(time) {
        const state = this.run.state;
        const [energy, momentum] = [this.run.energy, this.scene.angularMomentum(state)];
        Object.assign(this, { time, present: { q: state[0], energy, momentum } });
        this.energy.add(time, energy);
        this.momentum.add(time, momentum);
        this.trail.push(this.scene.points(state[0]).at(-1));
        if (this.trail.length > TRAIL) this.trail.shift();
    }

    // A step that fails ends this run and no other.
    step(time) {
        if (this.failure) return;
        try {
            for (let part = 0; part < this.parts; part++) this.run.step();
            this.look(time);
        } catch (error) {
            this.failure = error.message;
        }
    }
}

export class Comparison {
    #origin = 0;
    #since = 0;

    constructor(module, scene, rule, parameters, h) {
        const { name, start: { q, v } } = scene;
        Object.assign(this, { scene, parameters, h, steps: 0 });
        module.clear();
        const of = (kind, h) => new RuleRun(module, `${name}_${kind}`, parameters, h, q, v);
        const rungeKutta = () => new RungeKuttaRun(module, `${name}_runge_kutta`, `${name}_midpoint`, parameters, h, q, v);
        this.courses = {
            reference: new Course(scene, of("reference", h / PARTS), PARTS),
            rule: new Course(scene, of(rule, h), 1),
            rungeKutta: new Course(scene, rungeKutta(), 1),
        };
        // Copies of the runs, to take their time by.
        this.spare = { rule: of(rule, h), rungeKutta: rungeKutta() };
    }

    get time() {
        return this.#origin + this.#since * this.h;
    }

    step() {
        this.steps += 1;
        this.#since += 1;
        const courses = Object.values(this.courses);
        for (const course of courses) course.step(this.time);
        const { q } = this.courses.reference.present;
        for (const course of courses) {
            const distances = q.map((value, i) => Math.abs(course.present.q[i] - value));
            if (course.parted === null && Math.max(...distances) > APART) course.parted = this.time;
        }
    }

    // Gives RK4 as many steps to one of the rule as cost the same, by a measurement of both.
    equalCost() {
        const [rule, rungeKutta] = ["rule", "rungeKutta"].map((kind) => this.rate(kind));
        if (rule === 0 || rungeKutta === 0) return;
        this.courses.rungeKutta.parts = Math.max(1, Math.round(rungeKutta / rule));
        this.changeStepSize(this.h);
    }

    changeParameters(parameters) {
        this.parameters = { ...parameters };
        for (const { run } of Object.values(this.courses)) run.changeParameters(this.parameters);
    }

    changeStepSize(h) {
        [this.#origin, this.#since, this.h] = [this.time, 0, h];
        for (const { run, parts } of Object.values(this.courses)) run.changeStepSize(h / parts);
    }

    // Steps a second of "rule" or "rungeKutta" from the present state, measured on a copy: the quickest of three turns of some
    // milliseconds, as other programs slow down the others. 0 where it has failed, or fails there.
    rate(kind) {
        if (this.courses[kind].failure) return 0;
        try {
            return Math.max(...[1, 2, 3].map(() => this.#turn(kind)));
        } catch {
            return 0;
        }
    }

    #turn(kind) {
        const run = this.spare[kind];
        run.follow(this.courses[kind].run);
        const start = performance.now();
        let [steps, taken] = [0, 0];
        while (taken < 2) {
            for (let step = 0; step < 100; step++) run.step();
            steps += 100;
            taken = performance.now() - start;
        }
        return (1000 * steps) / taken;
    }
}
