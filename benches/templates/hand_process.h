/* Blocks, shifts, digits and floats, as firmware has them. */

static inline void copy(int16_t *to, const int16_t *from, size_t count) { memmove(to, from, count * sizeof *to); }

static inline void fill(int16_t *to, size_t count, int16_t value) {
  for (size_t i = 0; i < count; i++) to[i] = value;
}

/* All bits move on by one, and one enters. */
static inline void shift(bool *bits, size_t count, bool enters) {
  memmove(bits + 1, bits, count - 1);
  bits[0] = enters;
}

/* Four decimal digits; other values stay. */
static inline void pack(int16_t *to, int16_t value) {
  if (value >= 0 && value <= 9999)
    *to = (int16_t)(value / 1000 << 12 | value / 100 % 10 << 8 | value / 10 % 10 << 4 | value % 10);
}

static inline int16_t rotate(int16_t value, int places) {
  const uint16_t bits = (uint16_t)value;
  return (int16_t)(uint16_t)(bits << places | bits >> (16 - places));
}

static inline float get_float(const int16_t *d) {
  float value;
  memcpy(&value, d, sizeof value);
  return value;
}

static inline void put_float(int16_t *d, float value) { memcpy(d, &value, sizeof value); }
