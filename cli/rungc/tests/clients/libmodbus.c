/* Talks to a Modbus slave of `rungc run` with libmodbus: libmodbus rtu LINE, or libmodbus tcp PORT.
 *
 * The program adds D0 and D1 to D2 and shows M0 at Y000. The model is H2U, the station 1. */
#include <errno.h>
#include <modbus.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static modbus_t *plc;

static void fail(const char *what) {
    fprintf(stderr, "%s: %s\n", what, modbus_strerror(errno));
    exit(1);
}

#define MUST(condition) ((condition) ? (void)0 : fail(#condition))

/* A loaded machine may deliver a request with a pause in it, which cuts the frame: ask again. */
static int again;
#define ASK(call) \
    for (again = 0; (call) < 0; again++) { \
        if (errno != ETIMEDOUT || again == 100) fail(#call); \
        modbus_flush(plc); \
    }

int main(int argc, char **argv) {
    uint16_t words[125];
    uint8_t bits[64];
    MUST(argc == 3);
    int serial = strcmp(argv[1], "rtu") == 0;
    plc = serial ? modbus_new_rtu(argv[2], 9600, 'N', 8, 1) : modbus_new_tcp("127.0.0.1", atoi(argv[2]));
    MUST(plc != NULL);
    MUST(modbus_set_slave(plc, 1) == 0);
    MUST(modbus_set_response_timeout(plc, 4, 0) == 0);
    MUST(modbus_connect(plc) == 0);

    const uint16_t terms[] = {30000, 7};
    ASK(modbus_write_registers(plc, 0, 2, terms));
    for (int tries = 0; tries < 30000; tries++) {
        ASK(modbus_read_registers(plc, 0, 3, words));
        if (words[2] == 30007) break;
        usleep(10000);
    }
    MUST(words[0] == 30000 && words[1] == 7 && words[2] == 30007);
    ASK(modbus_read_input_registers(plc, 0, 125, words));
    MUST(words[0] == 30000);
    ASK(modbus_write_register(plc, 500, 0xbeef));
    ASK(modbus_read_registers(plc, 500, 1, words));
    MUST(words[0] == 0xbeef);

    ASK(modbus_write_bit(plc, 0, 1));
    for (int tries = 0; tries < 30000; tries++) {
        ASK(modbus_read_bits(plc, 0xfc00, 1, bits));
        if (bits[0]) break;
        usleep(10000);
    }
    MUST(bits[0] == 1);
    const uint8_t pattern[10] = {1, 1, 0, 1, 0, 0, 1, 0, 1, 1};
    ASK(modbus_write_bits(plc, 200, 10, pattern));
    ASK(modbus_read_bits(plc, 200, 10, bits));
    MUST(memcmp(bits, pattern, 10) == 0);
    ASK(modbus_read_input_bits(plc, 0xf800, 8, bits));
    MUST(bits[0] == 0 && bits[7] == 0);

    /* No such device; nothing is written to inputs; no such functions. */
    MUST(modbus_read_registers(plc, 0xe800, 1, words) < 0 && errno == EMBXILADD);
    MUST(modbus_write_bit(plc, 0xf800, 1) < 0 && errno == EMBXILADD);
    MUST(modbus_mask_write_register(plc, 0, 0, 0) < 0 && errno == EMBXILFUN);
    /* On a line, its frame has four bytes: too short for H2U (h1u-h2u-programming §8.1), which does not answer. */
    MUST(modbus_set_response_timeout(plc, 1, 0) == 0);
    MUST(modbus_report_slave_id(plc, sizeof bits, bits) < 0 && errno == (serial ? ETIMEDOUT : EMBXILFUN));
    modbus_close(plc);
    modbus_free(plc);
    puts("all answers are right");
    return 0;
}
