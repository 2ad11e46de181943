// The motion itself: where each method has come to, and the way behind it.

import { cleared } from "./canvas.js";
import { methods } from "./methods.js";

// Draws `courses` of `scene` on a square canvas.
export function drawMotion(canvas, scene, courses) {
    const { context, width, height } = cleared(canvas);
    const unit = Math.min(width, height) / (2 * scene.reach);
    const at = ([x, y]) => [width / 2 + unit * x, height / 2 - unit * y];
    const path = (points) => {
        context.beginPath();
        for (const point of points) context.lineTo(...at(point));
        context.stroke();
    };
    const disc = (point, radius) => {
        context.beginPath();
        context.arc(...at(point), radius, 0, 2 * Math.PI);
        context.fill();
    };

    context.strokeStyle = "#bbb";
    context.lineWidth = 1;
    for (const radius of scene.circles) {
        context.beginPath();
        context.arc(...at([0, 0]), unit * radius, 0, 2 * Math.PI);
        context.stroke();
    }
    for (const [method, { colour, width: wide }] of Object.entries(methods)) {
        const width = 0.5 + 0.5 * wide;
        const { trail, present } = courses[method];
        context.strokeStyle = context.fillStyle = colour;
        context.globalAlpha = 0.35;
        context.lineWidth = width;
        path(trail);
        context.globalAlpha = 1;
        const points = scene.points(present.q);
        context.lineWidth = width + 1;
        path(points);
        for (const point of points) disc(point, 3 + width);
    }
}
