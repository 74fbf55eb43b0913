// Edges that the program counts, or that start its interrupt routines: an interrupt notes each, PROGRAM_poll takes it.
static rungc_edges edges;

static bool next_edge(void *, rungc_edge *edge)
{
    return rungc_take_edge(&edges, edge);
}

static void note(uint16_t number)
{
    bool on = false;
    if (read_input(nullptr, number, &on)) {
        rungc_note_edge(&edges, number, on);
    }
}

static void attach(uint16_t number, void (*handler)())
{
    for (size_t i = 0; i < INPUTS; i++) {
        if (inputs[i].number == number && inputs[i].pin != NOT_CONNECTED) {
            attachInterrupt(digitalPinToInterrupt(inputs[i].pin), handler, CHANGE);
        }
    }
}

