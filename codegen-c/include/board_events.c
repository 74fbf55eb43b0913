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

