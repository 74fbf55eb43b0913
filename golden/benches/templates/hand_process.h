/* Blocks, shifts, queues, digits and floats, as firmware has them. */

static inline void copy(int16_t *to, const int16_t *from, size_t count) { memmove(to, from, count * sizeof *to); }

static inline void fill(int16_t *to, size_t count, int16_t value) {
  for (size_t i = 0; i < count; i++) to[i] = value;
}

/* All bits move on by one, and one enters. */
static inline void shift(bool *bits, size_t count, bool enters) {
  memmove(bits + 1, bits, count - 1);
  bits[0] = enters;
}

/* A queue: its first word counts the entries that follow. A full one stays as it is. */
static inline void append(int16_t *queue, int words, int16_t value) {
  if (queue[0] < words - 1) queue[++queue[0]] = value;
}

/* The oldest entry leaves, the others move down. */
static inline void take(int16_t *queue, int words, int16_t *to) {
  if (queue[0] > 0) {
    const int16_t oldest = queue[1];
    copy(queue + 1, queue + 2, (size_t)words - 2);
    queue[0]--;
    *to = oldest;
  }
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
