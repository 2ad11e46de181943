// Runs of the module's systems, by a rule of dalembert or by RK4, both asked in the same way.

import { interfaces } from "./interface.js";

// Two coordinates each, in all scenes.
const VECTOR = 16;

// Parameters by name, as the module reads them; all are numbers of 8 bytes.
class Parameters {
    constructor(module, { size, offsets }) {
        Object.assign(this, { module, offsets, at: module.room(size) });
    }

    write(values) {
        for (const [name, offset] of Object.entries(this.offsets)) this.module.write(this.at + offset, [values[name]]);
    }
}

// A run by a rule: the C functions of one `c_api!`.
export class RuleRun {
    constructor(module, name, parameters, h, q, v) {
        const { memory: size, layout, parameters: fields } = interfaces[name];
        Object.assign(this, { module, name, size, layout, at: module.room(size) });
        this.parameters = new Parameters(module, fields);
        [this.first, this.second] = [module.room(VECTOR), module.room(VECTOR)];
        this.begin(parameters, h, q, v);
    }

    // A new run at configuration q and velocity v, with step size h.
    begin(parameters, h, q, v) {
        this.parameters.write(parameters);
        this.module.write(this.first, q);
        this.module.write(this.second, v);
        this.#call("init_with", this.size, this.layout, this.parameters.at, h, this.first, this.second);
    }

    #call(name, ...rest) {
        const status = this.module.functions[`${this.name}_${name}`](this.at, ...rest);
        if (status !== 0) throw new Error(this.module.text(this.module.functions[`${this.name}_text`](status)));
    }

    step() {
        this.#call("step", 0);
    }

    // (q, p).
    get state() {
        this.#call("state", this.first, this.second);
        return [this.module.read(this.first, 2), this.module.read(this.second, 2)];
    }

    get energy() {
        this.#call("energy", this.first);
        return this.module.numbers[this.first / 8];
    }

    changeParameters(parameters) {
        this.parameters.write(parameters);
        this.#call("set_parameters", this.parameters.at);
    }

    changeStepSize(h) {
        this.#call("set_step_size", h);
    }

    // Goes on as `other` would: a memory copied as a whole is another run.
    follow(other) {
        this.module.copy(other.at, this.at, this.size);
    }
}

// A run by RK4 of the module, from state to state in (q, v). Momentum and energy are those that the rule named gives at (q, v).
export class RungeKuttaRun {
    constructor(module, name, rule, parameters, h, q, v) {
        Object.assign(this, { module, values: parameters, h });
        this.take = module.functions[name];
        this.at = module.room(2 * VECTOR);
        module.write(this.at, [...q, ...v]);
        this.there = new RuleRun(module, rule, parameters, h, q, v);
    }

    step() {
        this.take(this.there.parameters.at, this.h, this.at);
    }

    // Throws where the motion has left the numbers.
    #look() {
        const motion = this.module.read(this.at, 4);
        this.there.begin(this.values, this.h, motion.subarray(0, 2), motion.subarray(2));
        return this.there;
    }

    get state() {
        return this.#look().state;
    }

    get energy() {
        return this.#look().energy;
    }

    changeParameters(parameters) {
        this.values = parameters;
        this.there.parameters.write(parameters);
    }

    changeStepSize(h) {
        this.h = h;
    }

    follow(other) {
        this.h = other.h;
        this.changeParameters(other.values);
        this.module.copy(other.at, this.at, 2 * VECTOR);
    }
}
