/* semihosting.c: a program that reads standard input and writes standard output, on a machine that has neither: the debugger does it. */
#include <stdio.h>
#include <stdlib.h>

void initialise_monitor_handles(void); /* of librdimon */
void fault_handler(void);
int __real_main(void);
int __wrap_main(void);

/* The linker puts this around `main`. */
int __wrap_main(void)
{
    initialise_monitor_handles();
    /* The debugger is slow: not a call for each line. Who waits for one flushes it. */
    setvbuf(stdout, NULL, _IOFBF, 4096);
    setvbuf(stdin, NULL, _IOFBF, 4096);
    exit(__real_main());
}

/* Status of a program that has met a fault of the processor. */
#define FAULT 100

void fault_handler(void)
{
    _Exit(FAULT);
}
