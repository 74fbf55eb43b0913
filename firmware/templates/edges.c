/* Gives the next input whose edges the program takes and that stands otherwise than it stood. */
static bool next_edge(void *context, rungc_edge *edge)
{
    static const uint16_t watched[] = {/* WATCHED */};
    static bool were[sizeof watched / sizeof watched[0]];

    for (size_t i = 0; i < sizeof watched / sizeof watched[0]; i++) {
        bool on;
        if (INPUT(context, watched[i], &on) && on != were[i]) {
            were[i] = on;
            edge->input = watched[i];
            edge->on = on;
            return true;
        }
    }
    return false;
}

