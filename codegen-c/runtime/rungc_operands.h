/*
 * rungc_operands.h: operands of instructions: devices, groups of bits, bits of words, constants, buffer memory.
 *
 * Private to the rungc_*.c files. Offsets count devices from the one that an operand names.
 */
#ifndef RUNGC_OPERANDS_H
#define RUNGC_OPERANDS_H

#include "rungc_devices.h"

/* What an instruction does with its operands. */
typedef rungc_fault rungc_work(const rungc_call *call, const rungc_operand operands[]);

/* Runs an instruction, and shows its error. */
void rungc_run(rungc_map *map, rungc_site site, const rungc_operand operands[], rungc_work *work);

/* Number of the device `offset` places after the one of an operand. Devices together are all general or all special. */
rungc_fault rungc_number_of(rungc_operand operand, int32_t offset, uint32_t *number);

/* A word, and a bit. */
rungc_fault rungc_read_word(const rungc_call *call, rungc_operand operand, int32_t offset, int16_t *value);
rungc_fault rungc_write_word(const rungc_call *call, rungc_operand operand, int32_t offset, int16_t value);
rungc_fault rungc_read_bit(const rungc_call *call, rungc_operand operand, int32_t offset, bool *on);
rungc_fault rungc_write_bit(const rungc_call *call, rungc_operand operand, int32_t offset, bool on);

/* 32 bits: a pair of words, a 32-bit counter, (Vn, Zn), or a group of up to eight digits. */
rungc_fault rungc_read_long(const rungc_call *call, rungc_operand operand, int32_t offset, int32_t *value);
rungc_fault rungc_write_long(const rungc_call *call, rungc_operand operand, int32_t offset, int32_t value);

/* A value of the width of the form. */
rungc_fault rungc_read(const rungc_call *call, rungc_operand operand, int32_t *value);
rungc_fault rungc_write(const rungc_call *call, rungc_operand operand, int32_t value);

/* The same, which is not negative, or lies from `least` to `most`. */
rungc_fault rungc_read_unsigned(const rungc_call *call, rungc_operand operand, uint32_t *value);
rungc_fault rungc_read_in(const rungc_call *call, rungc_operand operand, int32_t least, int32_t most, int32_t *value);

/* Element `n` of the table at an operand, as wide as the form. */
rungc_fault rungc_read_element(const rungc_call *call, rungc_operand operand, int32_t n, int32_t *value);
rungc_fault rungc_write_element(const rungc_call *call, rungc_operand operand, int32_t n, int32_t value);

/* A value of the width of the form without its sign. */
rungc_fault rungc_read_bits(const rungc_call *call, rungc_operand operand, uint32_t *bits);

/* Returns true if an operand names a bit: X, Y, M, S or a bit of a word. */
bool rungc_is_bit(rungc_operand operand);

/* Raw value of a built-in analog input. */
rungc_fault rungc_read_analog(const rungc_call *call, int32_t channel, int16_t *value);

/* Fails unless a word or a bit exists, or the first `count` words, bits or elements. */
rungc_fault rungc_check_word(const rungc_call *call, rungc_operand operand, int32_t offset);
rungc_fault rungc_check_bit(const rungc_call *call, rungc_operand operand, int32_t offset);
rungc_fault rungc_check_words(const rungc_call *call, rungc_operand operand, int32_t count);
rungc_fault rungc_check_bits(const rungc_call *call, rungc_operand operand, int32_t count);
rungc_fault rungc_check_elements(const rungc_call *call, rungc_operand operand, int32_t count);

/* A word of the buffer memory of a module. */
rungc_fault rungc_read_module(const rungc_call *call, uint16_t unit, int32_t address, int16_t *value);
rungc_fault rungc_write_module(const rungc_call *call, uint16_t unit, int32_t address, int16_t value);

#endif
