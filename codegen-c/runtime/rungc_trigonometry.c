/*
 * rungc_trigonometry.c: SIN, COS, TAN (FNC 130 to 132), without a mathematical library, so that every compiler gives the same bits.
 *
 * The algorithms are those of FreeBSD's msun, as in musl and in the crate libm, which the other engines use:
 *
 * ====================================================
 * Copyright (C) 1993 by Sun Microsystems, Inc. All rights reserved.
 *
 * Developed at SunPro and SunSoft, Sun Microsystems, Inc. businesses.
 * Permission to use, copy, modify, and distribute this
 * software is freely granted, provided that this notice
 * is preserved.
 * ====================================================
 */
#include "rungc_operands.h"

#ifdef __clang__
#pragma STDC FP_CONTRACT OFF
#endif

/* Half of pi, and its first 25 bits with the rest; 53 bits of 2/pi. */
#define HALF_PI 1.57079632679489661923
#define HALF_PI_HEAD 1.57079631090164184570
#define HALF_PI_TAIL 1.58932547735281966916e-08
#define PER_HALF_PI 6.36619772367581382433e-01

/* Added to a number and taken off again, it rounds it to an integer. */
#define ROUNDING 6755399441055744.0

/* 2^24. */
#define CHUNK 16777216.0

/* Bits of 2/pi after the point, 24 each, as many as a float needs. */
static const int32_t per_half_pi[] = {0xA2F983, 0x6E4E44, 0x1529FC, 0x2757D1, 0xF534DD, 0xC0DB62, 0x95993C, 0x439041,
                                      0xFE5163, 0xABDEBB, 0xC561B7, 0x246E3A, 0x424DD2, 0xE00649, 0x2EEA09, 0xD1921C};

/* Half of pi in pieces of 24 bits. */
static const double half_pi[] = {1.57079625129699707031e+00, 7.54978941586159635335e-08, 5.39030252995776476554e-15,
                                 3.28200341580791294123e-22};

/* Terms of 2/pi at first, less one; the most there may be. */
enum { TERMS = 3, MOST_TERMS = 12 };

/* A power of 2. */
static double power(int32_t exponent)
{
    const uint64_t bits = (uint64_t)(1023 + exponent) << 52;
    double value;

    (void)memcpy(&value, &bits, sizeof value);
    return value;
}

/* The product of a number and 2/pi, less multiples of 8, in chunks of 24 bits. */
typedef struct quotient {
    double terms[MOST_TERMS]; /* products with the chunks of 2/pi */
    int32_t chunks[MOST_TERMS];
    int32_t last;      /* index of the last term */
    int32_t exponent;  /* of the first one */
    int32_t quarters;  /* the integer part */
    int32_t above;     /* it is above one half: the next integer is nearer */
    double fraction;
} quotient;

/* Divides the terms into chunks, and finds the integer part. */
static void distil(quotient *q)
{
    const int32_t last = q->last;
    double z = q->terms[last];

    for (int32_t i = 0, j = last; j > 0; i++, j--) {
        const double head = (double)(int32_t)(z / CHUNK);

        q->chunks[i] = (int32_t)(z - (CHUNK * head));
        z = q->terms[j - 1] + head;
    }
    z *= power(q->exponent);
    z -= 8.0 * (double)(int64_t)(z * 0.125);
    q->quarters = (int32_t)z;
    z -= (double)q->quarters;
    q->above = 0;
    if (q->exponent > 0) {
        const uint32_t chunk = (uint32_t)q->chunks[last - 1];
        const uint32_t whole = chunk >> (uint32_t)(24 - q->exponent);
        const uint32_t rest = chunk - (whole << (uint32_t)(24 - q->exponent));

        q->quarters += (int32_t)whole;
        q->chunks[last - 1] = (int32_t)rest;
        q->above = (int32_t)(rest >> (uint32_t)(23 - q->exponent));
    } else if (q->exponent == 0) {
        q->above = (int32_t)((uint32_t)q->chunks[last - 1] >> 23);
    } else if (z >= 0.5) {
        q->above = 2;
    } else {
        /* below */
    }
    q->fraction = z;
}

/* Takes the quotient off the next integer. */
static void complement(quotient *q)
{
    const int32_t last = q->last;
    bool carry = false;

    q->quarters++;
    for (int32_t i = 0; i < last; i++) {
        const int32_t chunk = q->chunks[i];

        if (carry) {
            q->chunks[i] = 0xFFFFFF - chunk;
        } else if (chunk != 0) {
            carry = true;
            q->chunks[i] = 0x1000000 - chunk;
        } else {
            /* it stays */
        }
    }
    if (q->exponent == 1) {
        q->chunks[last - 1] = (int32_t)((uint32_t)q->chunks[last - 1] & 0x7FFFFFu);
    } else if (q->exponent == 2) {
        q->chunks[last - 1] = (int32_t)((uint32_t)q->chunks[last - 1] & 0x3FFFFFu);
    } else {
        /* nothing above */
    }
    if (q->above == 2) {
        q->fraction = 1.0 - q->fraction;
        if (carry) {
            q->fraction -= power(q->exponent);
        }
    }
}

/* Number of terms that are missing because those there cancel out; 0 if none. */
static int32_t missing_terms(const quotient *q)
{
    int32_t missing = 1;

    if (q->fraction != 0.0) {
        return 0;
    }
    for (int32_t i = TERMS; i < q->last; i++) {
        if (q->chunks[i] != 0) {
            return 0;
        }
    }
    while ((missing < TERMS) && (q->chunks[TERMS - missing] == 0)) {
        missing++;
    }
    return missing;
}

/* The fraction becomes the last chunk, and chunks of 0 go. */
static void close_chunks(quotient *q)
{
    if (q->fraction == 0.0) {
        q->last--;
        q->exponent -= 24;
        while ((q->last > 0) && (q->chunks[q->last] == 0)) {
            q->last--;
            q->exponent -= 24;
        }
        return;
    }
    const double z = q->fraction * power(-q->exponent);

    if (z >= CHUNK) {
        const double head = (double)(int32_t)(z / CHUNK);

        q->chunks[q->last] = (int32_t)(z - (CHUNK * head));
        q->last++;
        q->exponent += 24;
        q->chunks[q->last] = (int32_t)head;
    } else {
        q->chunks[q->last] = (int32_t)z;
    }
}

/* The remainder of `x` * 2^`exponent` by half of pi, of an integer of 24 bits; and the quotient modulo 8. */
static int32_t reduce_large(double x, int32_t exponent, double *remainder)
{
    const int32_t first = (exponent < 27) ? 0 : (exponent - 3) / 24;
    quotient q;
    double sum = 0.0;
    int32_t missing = TERMS + 1;

    q.last = -1;
    q.exponent = exponent - (24 * (first + 1));
    while (missing > 0) {
        for (int32_t i = 0; i < missing; i++) {
            q.last++;
            q.terms[q.last] = x * (double)per_half_pi[first + q.last];
        }
        distil(&q);
        if (q.above > 0) {
            complement(&q);
        }
        missing = missing_terms(&q);
    }
    close_chunks(&q);

    double scale = power(q.exponent);
    for (int32_t i = q.last; i >= 0; i--) {
        q.terms[i] = scale * (double)q.chunks[i];
        scale /= CHUNK;
    }
    /* The products with half of pi, the smallest first. */
    for (int32_t i = 0; i <= q.last; i++) {
        double product = 0.0;

        for (int32_t k = 0; (k <= TERMS) && ((i + k) <= q.last); k++) {
            product += half_pi[k] * q.terms[i + k];
        }
        sum += product;
    }
    *remainder = (q.above == 0) ? sum : -sum;
    return q.quarters;
}

/* The remainder of a finite number by half of pi, and the quotient. */
static int32_t reduce(float x, double *remainder)
{
    const uint32_t size = (uint32_t)plc_float_bits(x) & 0x7FFFFFFFu;
    const double exact = (double)x;

    if (size < 0x4DC90FDBu) {
        const double rounded = (exact * PER_HALF_PI) + ROUNDING;
        const double quarters = rounded - ROUNDING;

        *remainder = (exact - (quarters * HALF_PI_HEAD)) - (quarters * HALF_PI_TAIL);
        return (int32_t)quarters;
    }
    const uint32_t exponent = (size >> 23) - 150u;
    const float integer = plc_float(plc_int32(size - (exponent << 23)));
    const int32_t quarters = reduce_large((double)integer, (int32_t)exponent, remainder);

    if (x < 0.0f) {
        *remainder = -*remainder;
        return -quarters;
    }
    return quarters;
}

/* Sine, cosine and tangent of numbers up to a quarter of pi. */
static float small_sine(double x)
{
    const double z = x * x;
    const double w = z * z;
    const double r = -0.000198393348360966317347 + (z * 0.0000027183114939898219064);
    const double s = z * x;

    return (float)((x + (s * (-0.166666666416265235595 + (z * 0.0083333293858894631756)))) + ((s * w) * r));
}

static float small_cosine(double x)
{
    const double z = x * x;
    const double w = z * z;
    const double r = -0.00138867637746099294692 + (z * 0.0000243904487962774090654);

    return (float)(((1.0 + (z * -0.499999997251031003120)) + (w * 0.0416666233237390631894)) + ((w * z) * r));
}

static float small_tangent(double x, bool odd)
{
    const double z = x * x;
    const double t = 0.0533812378445670393523 + (z * 0.0245283181166547278873);
    const double w = z * z;
    const double s = z * x;
    const double u = 0.333331395030791399758 + (z * 0.133392002712976742718);
    double r = 0.00297435743359967304927 + (z * 0.00946564784943673166728);

    r = (x + (s * u)) + ((s * w) * (t + (w * r)));
    return (float)(odd ? (-1.0 / r) : r);
}

/* The quotient of a number up to 9/4 of pi by half of pi, rounded; -1 above that, and 0 with no remainder to take near 0. */
static int32_t few_quarters(float x)
{
    static const uint32_t ends[] = {0x3F490FDAu, 0x4016CBE3u, 0x407B53D1u, 0x40AFEDDFu, 0x40E231D5u};
    const uint32_t size = (uint32_t)plc_float_bits(x) & 0x7FFFFFFFu;

    for (int32_t i = 0; i < 5; i++) {
        if (size <= ends[i]) {
            return i;
        }
    }
    return -1;
}

/* The remainder and the quotient, of any finite number. */
static uint32_t quarters_of(float x, double *remainder)
{
    const int32_t few = few_quarters(x);
    int32_t quarters;

    if (few < 0) {
        quarters = reduce(x, remainder);
    } else if (x < 0.0f) {
        *remainder = (double)x + ((double)few * HALF_PI);
        quarters = -few;
    } else {
        *remainder = (double)x - ((double)few * HALF_PI);
        quarters = few;
    }
    return (uint32_t)quarters & 3u;
}

static bool is_tiny(float x)
{
    return ((uint32_t)plc_float_bits(x) & 0x7FFFFFFFu) < 0x39800000u;
}

static float sine(float x)
{
    double rest = 0.0;

    if (is_tiny(x)) {
        return x;
    }
    switch (quarters_of(x, &rest)) {
    case 0:
        return small_sine(rest);
    case 1:
        return small_cosine(rest);
    case 2:
        return small_sine(-rest);
    default:
        return -small_cosine(rest);
    }
}

static float cosine(float x)
{
    double rest = 0.0;

    if (is_tiny(x)) {
        return 1.0f;
    }
    switch (quarters_of(x, &rest)) {
    case 0:
        return small_cosine(rest);
    case 1:
        return small_sine(-rest);
    case 2:
        return -small_cosine(rest);
    default:
        return small_sine(rest);
    }
}

static float tangent(float x)
{
    double rest = 0.0;

    if (is_tiny(x)) {
        return x;
    }
    const uint32_t quarters = quarters_of(x, &rest);

    return small_tangent(rest, (quarters & 1u) != 0u);
}

/* ---- SIN, COS, TAN S D, S in radians ---------------------------------------------------------------------------------------------- */

/* A number that is finite. An integer constant is converted. */
static rungc_fault read_number(const rungc_call *call, rungc_operand s, float *number)
{
    int32_t bits = 0;
    const rungc_fault fault = rungc_read_long(call, s, 0, &bits);

    if (fault != RUNGC_OK) {
        return fault;
    }
    *number = (s.kind == RUNGC_OPERAND_KIND_CONST) ? (float)bits : plc_float(bits);
    return plc_is_finite(*number) ? RUNGC_OK : RUNGC_NO_DEVICE;
}

static rungc_fault write_number(const rungc_call *call, rungc_operand d, float number)
{
    return plc_is_finite(number) ? rungc_write_long(call, d, 0, plc_float_bits(number)) : RUNGC_NO_DEVICE;
}

static rungc_fault sin_of(const rungc_call *call, const rungc_operand operands[])
{
    float number = 0.0f;
    const rungc_fault fault = read_number(call, operands[0], &number);

    return (fault != RUNGC_OK) ? fault : write_number(call, operands[1], sine(number));
}

static rungc_fault cos_of(const rungc_call *call, const rungc_operand operands[])
{
    float number = 0.0f;
    const rungc_fault fault = read_number(call, operands[0], &number);

    return (fault != RUNGC_OK) ? fault : write_number(call, operands[1], cosine(number));
}

static rungc_fault tan_of(const rungc_call *call, const rungc_operand operands[])
{
    float number = 0.0f;
    const rungc_fault fault = read_number(call, operands[0], &number);

    return (fault != RUNGC_OK) ? fault : write_number(call, operands[1], tangent(number));
}

void rungc_sin(rungc_map *map, rungc_site site, rungc_operand s, rungc_operand d)
{
    const rungc_operand operands[] = {s, d};

    rungc_run(map, site, operands, sin_of);
}

void rungc_cos(rungc_map *map, rungc_site site, rungc_operand s, rungc_operand d)
{
    const rungc_operand operands[] = {s, d};

    rungc_run(map, site, operands, cos_of);
}

void rungc_tan(rungc_map *map, rungc_site site, rungc_operand s, rungc_operand d)
{
    const rungc_operand operands[] = {s, d};

    rungc_run(map, site, operands, tan_of);
}
