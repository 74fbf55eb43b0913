/* Limits, as firmware has them. */

static inline int16_t limit(int16_t low, int16_t high, int16_t value) {
  return value < low ? low : value > high ? high : value;
}

/* How far a value is from a range. */
static inline int16_t band(int16_t low, int16_t high, int16_t value) {
  return (int16_t)(value < low ? value - low : value > high ? value - high : 0);
}

static inline int16_t zone(int16_t below, int16_t above, int16_t value) {
  return (int16_t)(value < 0 ? value + below : value > 0 ? value + above : 0);
}
