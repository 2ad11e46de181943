/* A RISC-V: reset, the timer of a CLINT, and semihosting for text. */
#include "board.h"
#include "start.h"

#define TIME_LOW (*(volatile uint32_t *)0x0200bff8)
#define TIME_HIGH (*(volatile uint32_t *)0x0200bffc)
#define COMPARED_LOW (*(volatile uint32_t *)0x02004000)
#define COMPARED_HIGH (*(volatile uint32_t *)0x02004004)

#define CLOCK 10u /* MHz, of the timer emulated */

static uint64_t end;
static uint32_t ticks;

__attribute__((section(".vectors"), naked, used)) void reset(void)
{
    __asm__ volatile("la sp, stack_top\n la t0, fault\n csrw mtvec, t0\n j begin");
}

__attribute__((used)) static _Noreturn void begin(void)
{
    start();
}

__attribute__((used, aligned(4))) static _Noreturn void fault(void)
{
    board_exit(3);
}

static uint64_t now(void)
{
    uint32_t high, low;
    do {
        high = TIME_HIGH;
        low = TIME_LOW;
    } while (high != TIME_HIGH);
    return (uint64_t)high << 32 | low;
}

static void end_period(void)
{
    end += ticks;
    COMPARED_HIGH = UINT32_MAX;
    COMPARED_LOW = (uint32_t)end;
    COMPARED_HIGH = (uint32_t)(end >> 32);
}

void board_begin(uint32_t period)
{
    ticks = CLOCK * period;
    end = now();
    end_period();
    /* The timer wakes the processor; nothing is interrupted. */
    __asm__ volatile("csrs mie, %0" ::"r"(1u << 7));
}

void board_wait(void)
{
    while (now() < end)
        __asm__ volatile("wfi");
    end_period();
}

static void semihosting(uint32_t operation, const void *argument)
{
    register uint32_t a0 __asm__("a0") = operation;
    register const void *a1 __asm__("a1") = argument;
    __asm__ volatile(".balign 16\n"
                     ".option push\n"
                     ".option norvc\n"
                     "slli x0, x0, 0x1f\n"
                     "ebreak\n"
                     "srai x0, x0, 7\n"
                     ".option pop"
                     : "+r"(a0)
                     : "r"(a1)
                     : "memory");
}

void board_write(const char *text)
{
    semihosting(0x04, text);
}

_Noreturn void board_exit(int status)
{
    const uint32_t block[2] = {0x20026, (uint32_t)status};
    for (;;)
        semihosting(0x20, block);
}
