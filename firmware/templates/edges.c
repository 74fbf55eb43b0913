/* Edges of the inputs that the program watches. */
static rungc_edges edges;

/* Notes each of them whose state has changed. */
static void note_edges(void)
{
    static const uint16_t watched[] = {/* WATCHED */};
    static bool were[sizeof watched / sizeof watched[0]];

    for (size_t i = 0; i < sizeof watched / sizeof watched[0]; i++) {
        bool on;
        if (INPUT(board.hal.context, watched[i], &on) && on != were[i] && rungc_note_edge(&edges, watched[i], on)) {
            were[i] = on;
        }
    }
}

static bool next_edge(void *context, rungc_edge *edge)
{
    (void)context;
/* NOTE */    return rungc_take_edge(&edges, edge);
}

