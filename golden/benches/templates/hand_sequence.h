/* Sequences of states, as firmware has them. The outputs of a state stay on until the scan after the one that left it,
 * as the machine is used to. */

struct sequence {
  uint8_t state;         /* the active one; 0 waits for the start */
  uint16_t left;         /* those whose outputs are still on, one bit for each */
  uint32_t remaining_ms; /* of the active state's time */
};

/* Changes the state; `ms` is how long the next one lasts at least. */
static inline void enter(struct sequence *s, uint8_t state, uint32_t ms) {
  s->left |= (uint16_t)(1u << s->state);
  s->state = state;
  s->remaining_ms = ms;
}

/* The beginning of a scan; the emergency stop leads back to the start. */
static inline void sequence_begin(struct sequence *s, bool stop, uint32_t dt_ms) {
  if (stop) {
    s->left = (uint16_t)((s->left | 1u << s->state) & ~1u);
    s->state = 0;
  }
  s->remaining_ms -= s->remaining_ms < dt_ms ? s->remaining_ms : dt_ms;
}
