/* PID loops, as firmware has them. A loop has the words that an operator panel addresses. */
#include <math.h>

struct pid {
  int16_t sample_ms;
  int16_t action; /* bit 0: the output falls with the measured value */
  int16_t filter, kp; /* % */
  int16_t ti; /* 100 ms */
  int16_t kd; /* % */
  int16_t td; /* 10 ms */
  int16_t started;
  float pv1, pv2, d1, mv, ev1;
  uint16_t elapsed_ms;
  int16_t raw_pv, input_rise, input_fall, upper, lower, alarms;
};

union loop {
  struct pid pid;
  int16_t word[25];
};

enum { PID_OFF, PID_ON, PID_FRESH };

/* The change of the output in each sampling time: h1u-h2u-programming, §4.3.9; as FX3 starts, the first sample begins
 * where the output is and answers to the whole deviation. */
static inline void pid_run(struct pid *c, int16_t target, int16_t measured, int16_t *output, uint32_t dt_ms) {
  const float sv = target, raw = measured;
  const bool reverse = c->action & 1;
  if (!c->started) {
    c->pv1 = c->pv2 = raw;
    c->ev1 = 0.0f;
    c->raw_pv = measured;
    c->started = PID_FRESH;
    return;
  }
  c->elapsed_ms = (uint16_t)(c->elapsed_ms + dt_ms);
  if (c->elapsed_ms < c->sample_ms) return;
  c->elapsed_ms = (uint16_t)(c->elapsed_ms - c->sample_ms);
  if (c->started == PID_FRESH) {
    c->started = PID_ON;
    c->mv = *output;
  }
  const float ts = c->sample_ms, ti = c->ti * 100.0f, td = c->td * 10.0f;
  const float pv = raw + c->filter / 100.0f * (c->pv1 - raw);
  const float ev = reverse ? sv - pv : pv - sv;
  const float curve = pv - 2.0f * c->pv1 + c->pv2;
  const float lag = c->kd / 100.0f * td;
  const float d = td / (ts + lag) * (reverse ? -curve : curve) + lag / (ts + lag) * c->d1;
  c->mv += c->kp / 100.0f * (ev - c->ev1 + ts / ti * ev + d);
  if (c->mv > c->upper) c->mv = c->upper;
  if (c->mv < c->lower) c->mv = c->lower;
  c->pv2 = c->pv1;
  c->pv1 = pv;
  c->d1 = d;
  c->ev1 = ev;
  c->raw_pv = measured;
  *output = (int16_t)roundf(c->mv);
}
