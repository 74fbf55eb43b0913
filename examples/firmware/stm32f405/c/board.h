/* board.h: what the program needs of the board. */
#ifndef BOARD_H
#define BOARD_H

#include <stdbool.h>
#include <stdint.h>

/* Sets up pins and the clock. */
void board_init(void);

/* Milliseconds since board_init. */
uint32_t board_millis(void);

/* Microseconds since board_init, wrapping; their resolution is BOARD_TICK_US. */
#define BOARD_TICK_US 50u
uint32_t board_micros(void);

/* The program's: called in an interrupt each BOARD_TICK_US. */
void board_tick_handler(uint32_t now_us);

/* Keeps interrupts from coming, or lets them come again. */
void board_hold_interrupts(bool hold);

/* Sleeps until the next interrupt. */
void board_sleep(void);

/* The button. */
bool board_button(void);

/* Lamp 0 to 4. */
void board_lamp(unsigned lamp, bool on);

/* Semihosting, for a debugger or QEMU: text to the console, and the end of the program. */
void board_print(const char *text);
_Noreturn void board_exit(void);

#endif
