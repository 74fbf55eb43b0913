#include "test_board.h"
#include <stdio.h>

#define CHARACTER_US 1042u

static uint32_t now, behind, out_end;
static unsigned sent;
static rungc_characters received;

static uint32_t now_us(void *context)
{
    (void)context;
    return now - behind;
}

static void set_line(void *context, uint8_t port, const rungc_line_format *format)
{
    (void)context;
    (void)port;
    (void)format;
}

static bool receive(void *context, uint8_t port, uint32_t at_us, rungc_received *character)
{
    (void)context;
    return port == 1u && rungc_take_character(&received, at_us, character);
}

static uint32_t left(void)
{
    return (out_end - now <= UINT32_MAX / 2u) ? out_end - now : 0u;
}

static bool send(void *context, uint8_t port, uint8_t byte, uint32_t at_us)
{
    (void)context;
    (void)port;
    (void)byte;
    (void)at_us;
    sent++;
    out_end = now + left() + CHARACTER_US;
    return true;
}

static uint16_t unsent(void *context, uint8_t port, uint32_t at_us)
{
    (void)context;
    (void)port;
    (void)at_us;
    return (uint16_t)((left() + CHARACTER_US - 1u) / CHARACTER_US);
}

static void run(uint32_t begin, uint32_t misread)
{
    static const uint8_t request[8] = {1, 3, 0, 10, 0, 1, 0xA4, 0x08};
    test_plc plc;
    rungc_board board = {.hal = {.set_line = set_line, .receive = receive, .send = send, .unsent = unsent},
                         .now_us = now_us,
                         .period_us = 5000u};
    unsigned answered = 0;

    now = begin;
    out_end = begin;
    test_init(&plc);
    for (unsigned i = 0; i < 11u; i++) {
        unsigned next = i == 0u ? 8u : 0u;
        uint32_t due = now;
        sent = 0;
        for (uint32_t poll = 0; poll < 5000u; poll++) {
            if (next < 8u && now - due <= UINT32_MAX / 2u) {
                (void)rungc_note_character(&received, due, request[next++], RUNGC_CHAR_FAULT_NONE);
                due += CHARACTER_US;
            }
            behind = poll % 100u == 51u ? misread : 0u;
            test_poll(&plc, &board);
            now += 200u;
        }
        answered += sent == 7u ? 1u : 0u;
    }
    printf("%u\n", answered);
}

int main(void)
{
    static const uint32_t begins[] = BEGINS, misread[] = {0, 1000, 66666, 1000000};

    for (size_t i = 0; i < sizeof begins / sizeof begins[0]; i++) {
        for (size_t k = 0; k < 4u; k++) {
            run(begins[i], misread[k]);
        }
    }
    return 0;
}
