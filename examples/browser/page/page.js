// The page: its controls, the runs, and what is shown of them.

import { drawChart } from "./chart.js";
import { Comparison } from "./comparison.js";
import { methods, rules } from "./methods.js";
import { Module } from "./module.js";
import { drawMotion } from "./motion.js";
import { scenes } from "./scenes.js";

// Most of a frame that steps may take, in ms: the page stays awake.
const BUDGET = 8;
// How often the step rate is measured, in ms.
const PAUSE = 1000;
const SLIDERS = ["friction", "gravity", "h", "speed"];

const element = (id) => document.getElementById(id);
const show = (id, text) => (element(id).textContent = text);
const number = (value, digits) => value.toFixed(digits).replace("-", "−");

class Page {
    constructor(module) {
        this.module = module;
        this.running = true;
        for (const radio of document.querySelectorAll("input[name=scene]")) {
            radio.addEventListener("change", () => this.open(radio.value));
        }
        for (const id of SLIDERS) element(id).addEventListener("input", () => this.slide(id));
        for (const id of ["rule", "share"]) element(id).addEventListener("change", () => this.restart());
        element("restart").addEventListener("click", () => this.restart());
        element("pause").addEventListener("click", () => this.pause());
        this.open(document.querySelector("input[name=scene]:checked").value);
        requestAnimationFrame((now) => this.frame(now));
    }

    // Shows another scene, with the values that it begins with.
    open(name) {
        this.scene = scenes[name];
        const { parameters, h, speed, ranges } = this.scene;
        this.values = { ...parameters, h, speed };
        element("rule").value = this.scene.rule;
        for (const id of SLIDERS) {
            element(`${id}-control`).hidden = !(id in ranges);
            if (id in ranges) element(id).value = placeOf(this.values[id], ranges[id]);
        }
        SLIDERS.forEach((id) => this.describe(id));
        show("about", this.scene.about);
        show("energy-title", this.scene.energy.title);
        show("momentum-title", this.scene.momentum.title);
        this.restart();
    }

    describe(id) {
        const range = this.scene.ranges[id];
        if (range) show(`${id}-value`, `${+this.values[id].toPrecision(3)} ${range.unit}`.trim());
    }

    restart() {
        const { h, friction, gravity } = this.values;
        this.rule = element("rule").value;
        this.comparison = new Comparison(this.module, this.scene, this.rule, { friction, gravity }, h);
        if (element("share").value === "cost") this.comparison.equalCost();
        const { parts } = this.comparison.courses.rungeKutta;
        const rungeKutta = methods.rungeKutta.name + (parts > 1 ? `, h/${parts}` : "");
        this.names = { reference: "reference", rule: rules[this.rule], rungeKutta };
        this.owed = 0;
        this.measured = -Infinity;
        for (const method of Object.keys(methods)) show(`${method}-name`, this.names[method]);
    }

    // A slider was moved: the run goes on from where it is.
    slide(id) {
        this.values[id] = valueAt(element(id).value, this.scene.ranges[id]);
        this.describe(id);
        const { h, friction, gravity } = this.values;
        if (id === "h") this.comparison.changeStepSize(h);
        else if (id !== "speed") this.comparison.changeParameters({ friction, gravity });
    }

    pause() {
        this.running = !this.running;
        show("pause", this.running ? "Pause" : "Go on");
    }

    frame(now) {
        const passed = Math.min(now - (this.before ?? now), 100) / 1000;
        this.before = now;
        if (this.running) {
            this.advance(passed * this.values.speed);
            if (now - this.measured > PAUSE) this.measure(now);
        }
        this.draw();
        requestAnimationFrame((now) => this.frame(now));
    }

    // Steps over this time, as far as the frame has room; what a slow machine cannot do is not made up for.
    advance(time) {
        const until = performance.now() + BUDGET;
        this.owed += time;
        while (this.owed >= this.comparison.h && performance.now() < until) {
            this.comparison.step();
            this.owed -= this.comparison.h;
        }
        this.owed = Math.min(this.owed, this.comparison.h);
    }

    measure(now) {
        this.measured = now;
        for (const kind of ["rule", "rungeKutta"]) {
            const rate = this.comparison.rate(kind);
            show(`${kind}-rate`, rate ? `${+rate.toPrecision(2)}`.replace(/\B(?=(\d{3})+$)/g, "\u202f") : "–");
        }
    }

    draw() {
        const { scene, comparison: { courses, time, steps } } = this;
        drawMotion(element("motion"), scene, courses);
        for (const quantity of ["energy", "momentum"]) {
            const of = (what) => Object.fromEntries(Object.keys(methods).map((method) => [method, what(courses[method])]));
            const axes = { end: Math.max(time, scene.span), time: scene.time, widest: scene[quantity].widest };
            const [histories, ends] = [of((course) => course[quantity]), of((course) => course.present[quantity])];
            drawChart(element(quantity), histories, ends, this.names, axes);
        }
        for (const [method, { present, failure, time, parted }] of Object.entries(courses)) {
            show(`${method}-energy`, number(present.energy, 5));
            show(`${method}-momentum`, number(present.momentum, 5));
            const apart = scene.isChaotic && parted !== null;
            const note = apart
                ? `${this.names[method]}: another motion than the reference's since t = ${number(parted, 1)}. From there on momenta do not compare, energies do.`
                : "";
            show(`${method}-note`, failure ? `ended at t = ${number(time, 1)}: ${failure}` : note);
        }
        show("time", number(time, 1));
        show("steps", String(steps));
    }
}

// Sliders go from 0 to 1000, in equal ratios; the left end of some is 0.
function valueAt(place, { least, most, zero }) {
    return zero && +place === 0 ? 0 : +(least * (most / least) ** (place / 1000)).toPrecision(3);
}

function placeOf(value, { least, most }) {
    return value === 0 ? 0 : (1000 * Math.log(value / least)) / Math.log(most / least);
}

try {
    new Page(await Module.load("live.wasm"));
} catch (error) {
    show("about", `The module cannot be run: ${error.message}`);
    throw error;
}
