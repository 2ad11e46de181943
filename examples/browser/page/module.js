// The WebAssembly module: its functions, and room in its memory.

const PAGE = 65536;

export class Module {
    #end;
    #numbers;

    // The module at `address`. It imports nothing.
    static async load(address) {
        const answer = await fetch(address);
        if (!answer.ok) throw new Error(`${address}: ${answer.status} ${answer.statusText}`);
        const { instance } = await WebAssembly.instantiate(await answer.arrayBuffer(), {});
        return new Module(instance.exports);
    }

    constructor(functions) {
        this.functions = functions;
        this.memory = functions.memory;
        this.clear();
    }

    // Gives up all room: what was placed there is not to be used again.
    clear() {
        this.#end = (this.functions.__heap_base.value + 7) & ~7;
    }

    // The address of room for so many bytes, behind what the module itself uses.
    room(bytes) {
        const at = this.#end;
        this.#end = (at + bytes + 7) & ~7;
        const missing = this.#end - this.memory.buffer.byteLength;
        if (missing > 0) this.memory.grow(Math.ceil(missing / PAGE));
        return at;
    }

    // The memory as numbers; a memory that has grown is another buffer.
    get numbers() {
        if (this.#numbers?.buffer !== this.memory.buffer) this.#numbers = new Float64Array(this.memory.buffer);
        return this.#numbers;
    }

    read(at, count) {
        return this.numbers.slice(at / 8, at / 8 + count);
    }

    write(at, values) {
        this.numbers.set(values, at / 8);
    }

    copy(from, to, bytes) {
        new Uint8Array(this.memory.buffer).copyWithin(to, from, from + bytes);
    }

    // Text that ends with a zero byte.
    text(at) {
        const bytes = new Uint8Array(this.memory.buffer);
        return new TextDecoder().decode(bytes.slice(at, bytes.indexOf(0, at)));
    }
}
