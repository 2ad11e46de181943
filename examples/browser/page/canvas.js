// A canvas as sharp as the screen, whatever width the page gives it.

export const FONT = 13;

// The context of `canvas`, cleared, with pixels of the page as units; and its size in them.
export function cleared(canvas) {
    const ratio = window.devicePixelRatio || 1;
    const { clientWidth: width, clientHeight: height } = canvas;
    const [across, down] = [Math.round(width * ratio), Math.round(height * ratio)];
    if (canvas.width !== across || canvas.height !== down) [canvas.width, canvas.height] = [across, down];
    const context = canvas.getContext("2d");
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    context.font = `${FONT}px system-ui, sans-serif`;
    context.lineJoin = "round";
    return { context, width, height, ratio };
}
