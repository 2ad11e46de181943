/* From reset to main: the same for all processors. Symbols are the linker script's. */
#ifndef START_H
#define START_H

#include <stdint.h>

#include "board.h"

extern uint32_t data_load[], data_start[], data_end[], bss_start[], bss_end[];

int main(void);

static inline _Noreturn void start(void)
{
    const uint32_t *from = data_load;
    uint32_t *to;

    for (to = data_start; to != data_end; to++)
        *to = *from++;
    for (to = bss_start; to != bss_end; to++)
        *to = 0;
    board_exit(main());
}

#endif
