/* Timers and counters, as firmware has them. */

struct timer { uint32_t elapsed_ms; bool on, done; };
struct counter { int16_t value; bool on, done; };

/* Runs while its input is on, from the scan after it came on. */
static inline void timer_run(struct timer *t, bool on, uint32_t preset_ms, uint32_t dt_ms) {
  if (!on) {
    *t = (struct timer){0};
  } else if (!t->on) {
    t->on = true;
  } else if (!t->done) {
    t->elapsed_ms += dt_ms;
    t->done = t->elapsed_ms >= preset_ms;
  }
}

/* Counts each time its input comes on. */
static inline void counter_run(struct counter *c, bool on, int16_t preset) {
  if (on && !c->on && !c->done) {
    c->value++;
    if (c->value >= preset) {
      c->value = preset;
      c->done = true;
    }
  }
  c->on = on;
}
