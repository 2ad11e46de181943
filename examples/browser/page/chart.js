// Curves against time, each labelled at its end.

import { cleared, FONT } from "./canvas.js";
import { COLUMNS } from "./history.js";
import { methods } from "./methods.js";

const [LEFT, RIGHT, TOP, BOTTOM] = [56, 78, 8, 38];

// A round step that makes at most `count` parts of `range`.
function tick(range, count) {
    const least = range / count;
    const power = 10 ** Math.floor(Math.log10(least));
    return power * [1, 2, 5, 10].find((step) => step * power >= least);
}

// What of [least, most] the histories reach, with a margin.
function extent(histories, [least, most]) {
    let [low, high] = [Infinity, -Infinity];
    for (const history of histories) {
        for (let column = 0; column < COLUMNS; column++) {
            low = Math.min(low, history.least[column]);
            high = Math.max(high, history.most[column]);
        }
    }
    [low, high] = [Math.max(low, least), Math.min(high, most)];
    const margin = Math.max(0.06 * (high - low), 1e-9 * (most - least));
    return [low - margin, high + margin];
}

function curve(context, history, x, y) {
    context.beginPath();
    for (let column = 0; column < COLUMNS; column++) {
        if (history.least[column] > history.most[column]) continue;
        const at = x(((column + 0.5) / COLUMNS) * history.end);
        context.lineTo(at, y(history.most[column]));
        context.lineTo(at, y(history.least[column]));
    }
    context.stroke();
}

// Draws `histories`, by the name of their method, on `canvas` from time 0 to `end`; `ends` are the values at which they are
// labelled, by `names`. The axes say `time`, and show no more than `widest`.
export function drawChart(canvas, histories, ends, names, { end, time, widest }) {
    const { context, width, height, ratio } = cleared(canvas);
    const [across, down] = [width - LEFT - RIGHT, height - TOP - BOTTOM];
    const [low, high] = extent(Object.values(histories), widest);
    const x = (time) => LEFT + (time / end) * across;
    const y = (value) => TOP + ((high - value) / (high - low)) * down;

    context.lineWidth = 1;
    context.strokeStyle = "#ddd";
    context.fillStyle = "#222";
    context.textBaseline = "middle";
    context.textAlign = "right";
    const step = tick(high - low, Math.max(2, down / 40));
    const digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    for (let value = Math.ceil(low / step) * step; value <= high; value += step) {
        line(context, LEFT, y(value), LEFT + across, y(value));
        context.fillText((Math.round(value / step) * step).toFixed(digits).replace("-", "−"), LEFT - 6, y(value));
    }
    context.textAlign = "center";
    context.textBaseline = "top";
    const pace = tick(end, Math.max(2, across / 90));
    for (let time = 0; time <= end * (1 + 1e-9); time += pace) {
        line(context, x(time), TOP, x(time), TOP + down);
        context.fillText(String(+time.toPrecision(6)), x(time), TOP + down + 5);
    }
    context.fillText(time, LEFT + across / 2, TOP + down + 5 + FONT + 4);

    context.save();
    context.beginPath();
    context.rect(LEFT, TOP, across, down);
    context.clip();
    for (const [method, { colour, width }] of Object.entries(methods)) {
        context.strokeStyle = colour;
        context.lineWidth = width;
        curve(context, histories[method], x, y);
    }
    context.restore();
    label(context, LEFT + across + 6, ends, names, y, [TOP, TOP + down]);
    // For those who read the picture by script: where the axes are, in pixels of the canvas.
    const [left, top] = [LEFT * ratio, TOP * ratio];
    const span = histories.rule.end / COLUMNS;
    canvas.dataset.axes = JSON.stringify({ span, end, low, high, left, top, width: across * ratio, height: down * ratio });
}

function line(context, x0, y0, x1, y1) {
    context.beginPath();
    context.moveTo(x0, y0);
    context.lineTo(x1, y1);
    context.stroke();
}

// The names of the curves where they end, as near as they have room.
function label(context, x, ends, names, y, [top, bottom]) {
    context.textAlign = "left";
    context.textBaseline = "middle";
    const labels = Object.entries(ends)
        .map(([method, value]) => ({ method, at: Math.min(Math.max(y(value), top + FONT / 2), bottom - FONT / 2) }))
        .sort((a, b) => a.at - b.at);
    const apart = FONT + 3;
    labels.forEach((label, i) => {
        if (i > 0) label.at = Math.max(label.at, labels[i - 1].at + apart);
    });
    const beyond = labels.length > 0 ? Math.max(0, labels.at(-1).at - (bottom - FONT / 2)) : 0;
    for (let i = labels.length - 1; i >= 0; i--) {
        const below = labels[i + 1]?.at ?? Infinity;
        if (beyond > 0) labels[i].at = Math.min(labels[i].at, i === labels.length - 1 ? bottom - FONT / 2 : below - apart);
        context.fillStyle = methods[labels[i].method].colour;
        context.fillText(names[labels[i].method], x, labels[i].at);
    }
}
