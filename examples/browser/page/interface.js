// Written by `cargo run --release interface`: change the Rust source, and write it again.
// Of each run: bytes of its memory, its layout, bytes of its parameters and where each of them begins.
export const interfaces = {
    ring_midpoint: {
        memory: 168,
        layout: 0x7114e53f0d037a26n,
        parameters: { size: 8, offsets: { friction: 0 } },
    },
    ring_trapezoidal: {
        memory: 192,
        layout: 0x56abe7216096287cn,
        parameters: { size: 8, offsets: { friction: 0 } },
    },
    ring_gauss: {
        memory: 256,
        layout: 0x689a01f8b07da0d8n,
        parameters: { size: 8, offsets: { friction: 0 } },
    },
    ring_reference: {
        memory: 288,
        layout: 0x3424dd0a2d2e5cban,
        parameters: { size: 8, offsets: { friction: 0 } },
    },
    double_pendulum_midpoint: {
        memory: 176,
        layout: 0x4ee9bb0604c2a32dn,
        parameters: { size: 16, offsets: { friction: 0, gravity: 8 } },
    },
    double_pendulum_trapezoidal: {
        memory: 176,
        layout: 0x18292d89b5c3c1cbn,
        parameters: { size: 16, offsets: { friction: 0, gravity: 8 } },
    },
    double_pendulum_gauss: {
        memory: 264,
        layout: 0x82fb6bf6f39d9611n,
        parameters: { size: 16, offsets: { friction: 0, gravity: 8 } },
    },
    double_pendulum_reference: {
        memory: 296,
        layout: 0x19a671259be4377bn,
        parameters: { size: 16, offsets: { friction: 0, gravity: 8 } },
    },
};
