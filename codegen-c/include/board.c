#include "PROGRAM_board.h"

/* Inputs and outputs of the program that are copied from and to pins; the last entry ends the list. */
static const uint16_t inputs[] = {/* INPUTS */UINT16_MAX};
static const uint16_t outputs[] = {/* OUTPUTS */UINT16_MAX};

/* An input terminal shows a level. */
static void show_input(PROGRAM_plc *plc, unsigned number, bool on)
{
    (void)plc;
    (void)on;
    switch (number) {
/* CASES */    default:
        break;
    }
}

/* EVENTS */
/* Reads the pins of inputs; unless `all` are wanted, of those that follow neither edges nor counts. */
static void read_inputs(PROGRAM_plc *plc, const rungc_board *board, bool all)
{
    for (size_t i = 0; board->hal.input != NULL && inputs[i] != UINT16_MAX; i++) {
        const uint16_t number = inputs[i];
        const bool follows = number < 32u && ((board->followed >> number) & 1u) != 0u;
        bool on = false;
        if ((all || !follows) && board->hal.input(board->hal.context, number, &on)) {
            show_input(plc, number, on);
        }
    }
}

/* A scan. */
static void scan(PROGRAM_plc *plc, rungc_board *board)
{
    const uint32_t begin = board->now_us(board->hal.context);

    PROGRAM_scan(plc, board->now_ms, board->scan_us);
    board->scan_us = rungc_board_between(begin, board->now_us(board->hal.context));
/* CONSTANT */}

/* Sets the pins of outputs, which a scan has changed, or a comparison at its count. The timer has those that send pulses. */
static void write_outputs(const PROGRAM_plc *plc, const rungc_board *board)
{
    for (size_t i = 0; board->hal.set_output != NULL && outputs[i] != UINT16_MAX; i++) {
        board->hal.set_output(board->hal.context, outputs[i], PROGRAM_output(plc, outputs[i]));
    }
}

void PROGRAM_poll(PROGRAM_plc *plc, rungc_board *board)
{
    const uint32_t now_us = board->now_us(board->hal.context);

    if (rungc_board_begins(board, now_us)) {
/* HAL */        read_inputs(plc, board, true);
    }
/* TAKE */
    /* PASSES */
/* INTERRUPTS */    const bool scans = rungc_board_scans(board, now_us);
    if (scans) {
        read_inputs(plc, board, false);
        scan(plc, board);
    }
    if (/* CHANGES */) {
        write_outputs(plc, board);
    }
/* PULSES */}
