/* Edges and long words, as firmware has them. */

static inline bool rising(bool *last, bool on) {
  const bool edge = on & !*last;
  *last = on;
  return edge;
}

/* A long is two registers; the machine's words are little-endian, too. */
static inline uint32_t get_long(const int16_t *d) {
  uint32_t value;
  memcpy(&value, d, sizeof value);
  return value;
}

static inline void put_long(int16_t *d, uint32_t value) {
  memcpy(d, &value, sizeof value);
}
