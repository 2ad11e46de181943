/* A Cortex-M with a floating-point unit: reset, the system timer, and semihosting for text. */
#include "board.h"
#include "start.h"

#define REGISTER(address) (*(volatile uint32_t *)(address))
#define TIMER_CONTROL REGISTER(0xe000e010)
#define TIMER_RELOAD REGISTER(0xe000e014)
#define TIMER_CURRENT REGISTER(0xe000e018)
#define INTERRUPT_STATE REGISTER(0xe000ed04)
#define COPROCESSOR_ACCESS REGISTER(0xe000ed88)

#define CLOCK 25u /* MHz, of the boards emulated */

void reset(void)
{
    COPROCESSOR_ACCESS |= 0xfu << 20;
    __asm__ volatile("dsb\n isb" ::: "memory");
    start();
}

static void fault(void)
{
    board_exit(3);
}

extern void stack_top(void);

__attribute__((section(".vectors"), used)) static void (*const vectors[16])(void) = {
    stack_top, reset, fault, fault, fault, fault, fault, fault, fault, fault, fault, fault, fault, fault, fault, fault,
};

void board_begin(uint32_t period)
{
    /* The timer wakes the processor; nothing is interrupted. */
    __asm__ volatile("cpsid i");
    TIMER_RELOAD = CLOCK * period - 1;
    TIMER_CURRENT = 0;
    TIMER_CONTROL = 7;
}

void board_wait(void)
{
    while (!(TIMER_CONTROL & 1u << 16))
        __asm__ volatile("wfi");
    INTERRUPT_STATE = 1u << 25;
}

static void semihosting(uint32_t operation, const void *argument)
{
    register uint32_t r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
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
