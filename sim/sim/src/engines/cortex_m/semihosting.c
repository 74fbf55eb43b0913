/* semihosting.c: a program that reads standard input and writes standard output, on a machine that has neither: its debugger has. */
#include <stdio.h>
#include <stdlib.h>

void initialise_monitor_handles(void); /* of librdimon */
void systick_handler(void);
int __real_main(void);
int __wrap_main(void);

/* Bytes that the debugger takes or gives at a time. */
#define BUFFER 4096

/* What the linker puts around `main`. */
int __wrap_main(void)
{
    initialise_monitor_handles();
    /* Not a call of the debugger for each line: who waits for one has it flushed. */
    setvbuf(stdin, NULL, _IOFBF, BUFFER);
    setvbuf(stdout, NULL, _IOFBF, BUFFER);
    exit(__real_main());
}

/* The clock is not started. */
void systick_handler(void)
{
}
