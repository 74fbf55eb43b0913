/* Digits and lamps, as firmware has them. */

/* Segments of a digit: a is bit 0. */
static const uint8_t segments[16] = {0x3F, 0x06, 0x5B, 0x4F, 0x66, 0x6D, 0x7D, 0x27,
                                     0x7F, 0x6F, 0x77, 0x7C, 0x39, 0x5E, 0x79, 0x71};

static inline void put_bits(bool *to, unsigned count, uint16_t value) {
  for (unsigned i = 0; i < count; i++) to[i] = value >> i & 1;
}

static inline uint16_t get_bits(const bool *from, unsigned count) {
  unsigned value = 0;
  for (unsigned i = 0; i < count; i++) value |= (unsigned)from[i] << i;
  return (uint16_t)value;
}

static inline bool is_decimal(int16_t value) { return value >= 0 && value <= 9999; }

static inline uint16_t digits(int16_t value) {
  return (uint16_t)(value / 1000 << 12 | value / 100 % 10 << 8 | value / 10 % 10 << 4 | value % 10);
}

/* The number on four thumbwheels; one between two digits shows none, and the last number stays. */
static inline void from_wheels(int16_t *to, uint16_t wheels) {
  const int a = wheels >> 12, b = wheels >> 8 & 15, c = wheels >> 4 & 15, d = wheels & 15;
  if (a <= 9 && b <= 9 && c <= 9 && d <= 9) *to = (int16_t)(1000 * a + 100 * b + 10 * c + d);
}

static inline void select_lamp(bool *lamps, int count, int lamp) {
  for (int i = 0; i < count; i++) lamps[i] = i == lamp;
}

/* The highest lamp that is on; without any, the last one stays selected. */
static inline void selected_lamp(int16_t *to, const bool *lamps, int count) {
  for (int i = count - 1; i >= 0; i--)
    if (lamps[i]) {
      *to = (int16_t)i;
      return;
    }
}
