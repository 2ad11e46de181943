// The least and the largest value of a curve in each of as many equal spans of time as a chart has columns. Where the time runs
// out of them each takes the place of two, so that all of a run is kept in bounded memory.

export const COLUMNS = 1024;

export class History {
    constructor(end) {
        this.end = end;
        this.least = new Float64Array(COLUMNS).fill(Infinity);
        this.most = new Float64Array(COLUMNS).fill(-Infinity);
    }

    add(time, value) {
        while (time >= this.end) this.#halve();
        const column = Math.floor((time / this.end) * COLUMNS);
        this.least[column] = Math.min(this.least[column], value);
        this.most[column] = Math.max(this.most[column], value);
    }

    #halve() {
        const half = COLUMNS / 2;
        for (let column = 0; column < half; column++) {
            this.least[column] = Math.min(this.least[2 * column], this.least[2 * column + 1]);
            this.most[column] = Math.max(this.most[2 * column], this.most[2 * column + 1]);
        }
        this.least.fill(Infinity, half);
        this.most.fill(-Infinity, half);
        this.end *= 2;
    }
}
