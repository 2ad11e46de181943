/* What the loop asks of a board. */
#ifndef BOARD_H
#define BOARD_H

#include <stdint.h>

/* Begins periods of so many microseconds. */
void board_begin(uint32_t period);

/* Sleeps until the present period ends; returns at once where it has ended. */
void board_wait(void);

/* Shows text: through the debugger, or by the emulator. */
void board_write(const char *text);

/* Stops; an emulator ends with this status. */
_Noreturn void board_exit(int status);

#endif
