/* Steps the pushed cart-pole 200 times through the functions of C, and reports what the device in Rust reports: the bits it ends
 * with, the instructions of a step, the stack. */
#include <stddef.h>

#include "board.h"
#include "cart_pole_f32.h"
#include "cart_pole_f64.h"

#define STEPS 200
#define PAINT 0xa5c396e1u

extern uint32_t stack_limit[], stack_top[];
extern uint32_t may_panic(size_t index);

/* What counts: ticks of the system timer, which the emulator derives from the instructions executed; or retired instructions. */
#ifdef __arm__
#define REGISTER(address) (*(volatile uint32_t *)(address))
#define CALIBRATION 100000u
static uint32_t calibration;

static uint32_t now(void)
{
    return REGISTER(0xe000e018);
}

static uint32_t ticks(uint32_t from)
{
    return (from - now()) & 0xffffff;
}

static void begin_counting(void)
{
    uint32_t from, loops = CALIBRATION / 2;
    REGISTER(0xe000e014) = 0xffffff;
    REGISTER(0xe000e018) = 0;
    REGISTER(0xe000e010) = 5;
    from = now();
    __asm__ volatile("1: subs %0, %0, #1\n bne 1b" : "+r"(loops)::"cc");
    calibration = ticks(from);
}

static uint32_t instructions(uint32_t from)
{
    return (uint32_t)((uint64_t)ticks(from) * CALIBRATION / calibration);
}
#else
static uint32_t now(void)
{
    uint32_t count;
    __asm__ volatile("csrr %0, minstret" : "=r"(count));
    return count;
}

static void begin_counting(void)
{
}

static uint32_t instructions(uint32_t from)
{
    return now() - from;
}
#endif

/* Numbers and words, ended by a space. */
static void write_number(uint32_t number)
{
    char text[12], *digit = text + sizeof text;
    *--digit = '\0';
    *--digit = ' ';
    do {
        *--digit = (char)('0' + number % 10);
        number /= 10;
    } while (number > 0);
    board_write(digit);
}

static void write_bits(uint64_t bits)
{
    char text[18];
    int i;
    for (i = 0; i < 16; i++)
        text[i] = "0123456789abcdef"[bits >> (60 - 4 * i) & 15];
    text[16] = ' ';
    text[17] = '\0';
    board_write(text);
}

/* FNV-1a over the bits of numbers. */
static uint64_t digest(uint64_t before, double number)
{
    const union {
        double number;
        uint64_t bits;
    } of = {number};
    return (before ^ of.bits) * UINT64_C(0x100000001b3);
}

static void paint_stack(void)
{
    /* Up to this call's own frame. */
    volatile uint32_t *word = stack_limit;
    for (; word < (uint32_t *)__builtin_frame_address(0) - 32; word++)
        *word = PAINT;
}

static void write_stack(const char *name)
{
    const volatile uint32_t *word = stack_limit;
    while (word < stack_top && *word == PAINT)
        word++;
    board_write("c_stack ");
    board_write(name);
    write_number((uint32_t)((const char *)stack_top - (const char *)word));
    board_write("\n");
}

static void require(int holds)
{
    if (!holds)
        board_exit(2);
}

#define NUMBER float
#define OF(name) cart_pole_f32##name
#define NAME "cart_pole_f32"
#include "steps.h"
#undef NUMBER
#undef OF
#undef NAME

#define NUMBER double
#define OF(name) cart_pole_f64##name
#define NAME "cart_pole_f64"
#include "steps.h"

int main(void)
{
    paint_stack();
    begin_counting();
    cart_pole_f32_steps();
    write_stack("f32 ");
    cart_pole_f64_steps();
    write_stack("f64 ");
#ifdef MAY_PANIC
    write_number(may_panic(now()));
#endif
    return 0;
}
