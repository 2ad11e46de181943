//! Machines that QEMU emulates.

/// A machine.
pub struct Machine {
    /// Its name to the task, and to the host's program that holds results against its own.
    pub name: &'static str,
    /// The target of rustc.
    pub target: &'static str,
    /// The processor, to rustc.
    pub processor: &'static str,
    /// Addresses of the program and of the variables of C.
    pub flash: &'static str,
    /// Address of the variables of C.
    pub ram: &'static str,
    /// The emulator, with its arguments.
    pub emulator: &'static str,
    /// The compiler of C, with its arguments.
    pub gcc: &'static str,
    /// The start of a program in C, in the template.
    pub start: &'static str,
}

const CORTEX_M: &str = "boards/cortex_m.c";

/// All of them.
pub const MACHINES: [Machine; 4] = [
    Machine {
        name: "m4f",
        target: "thumbv7em-none-eabihf",
        processor: "cortex-m4",
        flash: "0x00000000",
        ram: "0x20000000",
        emulator: "qemu-system-arm -machine mps2-an386 -icount shift=6,align=off,sleep=off",
        gcc: "arm-none-eabi-gcc -mcpu=cortex-m4 -mfloat-abi=hard",
        start: CORTEX_M,
    },
    Machine {
        name: "m7",
        target: "thumbv7em-none-eabihf",
        processor: "cortex-m7",
        flash: "0x00000000",
        ram: "0x20000000",
        emulator: "qemu-system-arm -machine mps2-an500 -icount shift=6,align=off,sleep=off",
        gcc: "arm-none-eabi-gcc -mcpu=cortex-m7 -mfloat-abi=hard",
        start: CORTEX_M,
    },
    Machine {
        name: "m33",
        target: "thumbv8m.main-none-eabihf",
        processor: "cortex-m33",
        flash: "0x10000000",
        ram: "0x38000000",
        emulator: "qemu-system-arm -machine mps2-an505 -icount shift=6,align=off,sleep=off",
        gcc: "arm-none-eabi-gcc -mcpu=cortex-m33 -mfloat-abi=hard",
        start: CORTEX_M,
    },
    Machine {
        name: "rv",
        target: "riscv32imac-unknown-none-elf",
        processor: "generic-rv32",
        flash: "0x80000000",
        ram: "0x80100000",
        emulator: "qemu-system-riscv32 -machine virt -cpu rv32 -bios none -icount shift=0",
        gcc: "riscv64-unknown-elf-gcc -march=rv32imac_zicsr -mabi=ilp32",
        start: "boards/riscv.c",
    },
];
