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

/* An input changes. */
static void change_input(PROGRAM_plc *plc, unsigned number, bool on)
{
    show_input(plc, number, on);
    PROGRAM_input_edge(plc, number, on);
}

/* Takes the edges that interrupts noted; whether there were any. */
static bool take_edges(PROGRAM_plc *plc, const rungc_board *board)
{
    rungc_edge edge;
    bool any = false;

    while (board->next_edge != NULL && board->next_edge(board->hal.context, &edge)) {
        any = true;
        change_input(plc, edge.input, edge.on);
/* EDGE */    }
    return any;
}

/* Takes one pulse. */
static void take_pulse(PROGRAM_plc *plc, unsigned number)
{
    change_input(plc, number, true);
    change_input(plc, number, false);
}

/* Takes the quarters by which an encoder has turned; in each one phase changes. */
static void turn(PROGRAM_plc *plc, const rungc_count *count)
{
    const uint32_t end = count->from + (uint32_t)count->count;
    uint32_t quarter = count->from;

    show_input(plc, count->input, rungc_phase_a(quarter));
    show_input(plc, count->phase_b, rungc_phase_b(quarter));
    while (quarter != end) {
        const uint32_t next = (count->count > 0) ? quarter + 1u : quarter - 1u;
        if (rungc_phase_a(next) != rungc_phase_a(quarter)) {
            change_input(plc, count->input, rungc_phase_a(next));
        } else {
            change_input(plc, count->phase_b, rungc_phase_b(next));
        }
        quarter = next;
    }
}

/* Takes what hardware counters have counted; whether that was anything. */
static bool take_counts(PROGRAM_plc *plc, const rungc_board *board)
{
    rungc_count count;
    bool any = false;

    for (unsigned i = 0; board->counted != NULL && board->counted(board->hal.context, i, &count); i++) {
        any = any || count.count != 0;
        if (count.phase_b != count.input) {
            turn(plc, &count);
        } else {
            for (; count.count > 0; count.count--) {
                take_pulse(plc, count.input);
            }
        }
    }
    return any;
}

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
    board->scan_us = board->now_us(board->hal.context) - begin;
}

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
    const bool edges = take_edges(plc, board);
    const bool counts = take_counts(plc, board);
    /* PASSES */
/* INTERRUPTS */    const bool scans = rungc_board_scans(board, now_us);
    if (scans) {
        read_inputs(plc, board, false);
        scan(plc, board);
    }
    if (scans || edges || counts) {
        write_outputs(plc, board);
    }
/* PULSES */}
