/*
 * rungc_rt.h: the runtime library of programs compiled by rungc. Made by cbindgen from runtime-rt; do not edit.
 *
 * A program describes its struct once (rungc_layout), binds it to one struct and the hardware (rungc_map), and calls one function
 * for each instruction that is not worth inlining. Only the functions that a program calls are linked.
 */

#ifndef RUNGC_RT_H
#define RUNGC_RT_H

#include "rungc.h"

/* Implementation of protocols for serial ports. */
typedef struct rungc_codec rungc_codec;

/* Devices that a model serves by Modbus. */
typedef struct rungc_modbus_profile rungc_modbus_profile;

/**
 * Inputs X whose edges an instruction takes notice of at once if it names them; others are looked at once a scan.
 */
#define Wiring_FAST_INPUTS 8

/**
 * Bytes of a monitor list of the programming port, which needs the most.
 */
#define RUNGC_MEMORY_SIZE 912

/**
 * Maximum number of characters of an answer.
 */
#define RUNGC_LONGEST_ANSWER 260

/**
 * Maximum number of characters of a request of any service.
 */
#define RUNGC_LONGEST_REQUEST 3882

/**
 * More characters than an answer of any service has.
 */
#define RUNGC_LONGEST_REPLY 8192

/**
 * The serial ports that a family of models has. The numbers are part of the C ABI.
 */
enum rungc_ports
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint8_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /**
     * None.
     */
    RUNGC_PORTS_WITHOUT = 0,
    /**
     * H1U, H2U: COM0 to COM3.
     */
    RUNGC_PORTS_INOVANCE = 1,
    /**
     * L01S: ports 1 to 3.
     */
    RUNGC_PORTS_L01S = 2,
    /**
     * HM: COM0 and COM1.
     */
    RUNGC_PORTS_HM = 3,
    /**
     * FX1S, FX1N, FX2N: the programming port, and the communication board.
     */
    RUNGC_PORTS_FX = 4,
    /**
     * Boards that are compatible with FX3U.
     */
    RUNGC_PORTS_BOARD3U = 5,
    /**
     * FX3S, FX3U: the programming port, and two channels.
     */
    RUNGC_PORTS_FX3 = 6,
    /**
     * FX3G: the same, and RS2 on the programming port.
     */
    RUNGC_PORTS_FX3G = 7,
    /**
     * Boards that are compatible with FX2N.
     */
    RUNGC_PORTS_BOARD2N = 8,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum rungc_ports rungc_ports;
#else
typedef uint8_t rungc_ports;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * Next action of a host on a connection.
 */
enum rungc_client_action
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint8_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /**
     * Nothing.
     */
    RUNGC_CLIENT_ACTION_NOTHING = 0,
    /**
     * It opens the connection.
     */
    RUNGC_CLIENT_ACTION_OPEN = 1,
    /**
     * It sends the request.
     */
    RUNGC_CLIENT_ACTION_SEND = 2,
    /**
     * It closes the connection.
     */
    RUNGC_CLIENT_ACTION_CLOSE = 3,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum rungc_client_action rungc_client_action;
#else
typedef uint8_t rungc_client_action;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * Device class. The numbers are part of the C ABI.
 */
enum rungc_class
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint8_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /**
     * Input relay.
     */
    RUNGC_CLASS_X = 0,
    /**
     * Output relay.
     */
    RUNGC_CLASS_Y = 1,
    /**
     * Auxiliary relay; from 8000 special.
     */
    RUNGC_CLASS_M = 2,
    /**
     * Step relay.
     */
    RUNGC_CLASS_S = 3,
    /**
     * Timer: contact as a bit, current value as a word.
     */
    RUNGC_CLASS_T = 4,
    /**
     * Counter: contact as a bit, current value as a word, or 32 bits from C200.
     */
    RUNGC_CLASS_C = 5,
    /**
     * Data register; from 8000 special.
     */
    RUNGC_CLASS_D = 6,
    /**
     * Extension register.
     */
    RUNGC_CLASS_R = 7,
    /**
     * Index register V.
     */
    RUNGC_CLASS_V = 8,
    /**
     * Index register Z.
     */
    RUNGC_CLASS_Z = 9,
    /**
     * Extension file register.
     */
    RUNGC_CLASS_ER = 10,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum rungc_class rungc_class;
#else
typedef uint8_t rungc_class;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * The state of a connection, as its host knows it.
 */
enum rungc_link
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint8_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /**
     * There is none.
     */
    RUNGC_LINK_CLOSED = 0,
    /**
     * It is being opened.
     */
    RUNGC_LINK_OPENING = 1,
    /**
     * Characters go over it.
     */
    RUNGC_LINK_OPEN = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum rungc_link rungc_link;
#else
typedef uint8_t rungc_link;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * Storage type of an area of devices.
 */
enum rungc_area_kind
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint8_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /**
     * `bool`.
     */
    RUNGC_AREA_KIND_BITS = 0,
    /**
     * `int16_t`.
     */
    RUNGC_AREA_KIND_WORDS = 1,
    /**
     * `plc_timer`.
     */
    RUNGC_AREA_KIND_TIMERS = 2,
    /**
     * `plc_counter16`.
     */
    RUNGC_AREA_KIND_COUNTERS16 = 3,
    /**
     * `plc_counter32`.
     */
    RUNGC_AREA_KIND_COUNTERS32 = 4,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum rungc_area_kind rungc_area_kind;
#else
typedef uint8_t rungc_area_kind;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * The pulse outputs of a family of models.
 */
enum rungc_pulses
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint8_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /**
     * None, or none that instructions name by output.
     */
    RUNGC_PULSES_WITHOUT = 0,
    /**
     * H1U, H2U.
     */
    RUNGC_PULSES_INOVANCE = 1,
    /**
     * L01S.
     */
    RUNGC_PULSES_L01S = 2,
    /**
     * FX2N.
     */
    RUNGC_PULSES_FX2N = 3,
    /**
     * FX3G, FX3U.
     */
    RUNGC_PULSES_FX3 = 4,
    /**
     * HM: axes, which are bound to outputs.
     */
    RUNGC_PULSES_HM = 5,
    /**
     * FX1S, FX1N.
     */
    RUNGC_PULSES_FX1 = 6,
    /**
     * FX2N-compatible boards.
     */
    RUNGC_PULSES_BOARD2N = 7,
    /**
     * FX3U-compatible boards.
     */
    RUNGC_PULSES_BOARD3U = 8,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum rungc_pulses rungc_pulses;
#else
typedef uint8_t rungc_pulses;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * The bit that makes a character odd or even.
 */
enum rungc_parity
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint8_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /**
     * There is none.
     */
    RUNGC_PARITY_NONE = 0,
    /**
     * The ones of a character are odd.
     */
    RUNGC_PARITY_ODD = 1,
    /**
     * The ones of a character are even.
     */
    RUNGC_PARITY_EVEN = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum rungc_parity rungc_parity;
#else
typedef uint8_t rungc_parity;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * Fault of a character.
 */
enum rungc_char_fault
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint8_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /**
     * Nothing.
     */
    RUNGC_CHAR_FAULT_NONE = 0,
    /**
     * Its parity.
     */
    RUNGC_CHAR_FAULT_PARITY = 1,
    /**
     * It has no stop bit.
     */
    RUNGC_CHAR_FAULT_FRAMING = 2,
    /**
     * A character before it was lost in the receiver.
     */
    RUNGC_CHAR_FAULT_OVERRUN = 3,
    /**
     * The line was held at 0 for longer than a character.
     */
    RUNGC_CHAR_FAULT_BREAK = 4,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum rungc_char_fault rungc_char_fault;
#else
typedef uint8_t rungc_char_fault;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * Request of a partner on a line to operate the RUN/STOP switch.
 */
enum rungc_request
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint8_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /**
     * Nothing.
     */
    RUNGC_REQUEST_NONE = 0,
    /**
     * RUN.
     */
    RUNGC_REQUEST_RUN = 1,
    /**
     * STOP.
     */
    RUNGC_REQUEST_STOP = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum rungc_request rungc_request;
#else
typedef uint8_t rungc_request;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * Interpretation of an [`Operand`]. The numbers are part of the C ABI.
 */
enum rungc_operand_kind
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint8_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /**
     * Integer constant `value`.
     */
    RUNGC_OPERAND_KIND_CONST = 0,
    /**
     * Float constant, its bits in `value`.
     */
    RUNGC_OPERAND_KIND_FLOAT = 1,
    /**
     * Device number `value` of `class`, as a bit or a word as the instruction asks.
     */
    RUNGC_OPERAND_KIND_DEVICE = 2,
    /**
     * Group of `4 * digits` bits from bit device `value` of `class`.
     */
    RUNGC_OPERAND_KIND_NIBBLES = 3,
    /**
     * Bit `digits` of word device `value` of `class`.
     */
    RUNGC_OPERAND_KIND_WORD_BIT = 4,
    /**
     * Text number `value` of the program.
     */
    RUNGC_OPERAND_KIND_TEXT = 5,
    /**
     * Word `value` of the buffer memory of module `digits`.
     */
    RUNGC_OPERAND_KIND_BUFFER = 6,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum rungc_operand_kind rungc_operand_kind;
#else
typedef uint8_t rungc_operand_kind;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * The protocols of servers.
 */
enum rungc_server_protocol
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint8_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /**
     * Modbus TCP, with the address table of the model.
     */
    RUNGC_SERVER_PROTOCOL_MODBUS_TCP = 0,
    /**
     * MC protocol, frames 1E and 3E, in binary and in ASCII.
     */
    RUNGC_SERVER_PROTOCOL_MC = 1,
    /**
     * The programming port's protocol, as the model speaks it.
     */
    RUNGC_SERVER_PROTOCOL_PROGRAMMING_PORT = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum rungc_server_protocol rungc_server_protocol;
#else
typedef uint8_t rungc_server_protocol;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * Effect of a character received by a connection.
 */
enum rungc_feed_result
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint8_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /**
     * Part of a request that continues, or of none.
     */
    RUNGC_FEED_RESULT_MORE = 0,
    /**
     * The last of a request, which has been carried out.
     */
    RUNGC_FEED_RESULT_REQUEST = 1,
    /**
     * The last of a request, which has been rejected.
     */
    RUNGC_FEED_RESULT_REJECTED = 2,
    /**
     * Not part of a request, or the last of one that is unknown or has a wrong length. Where the next request begins
     * is not known, so the connection is to be closed after the answer.
     */
    RUNGC_FEED_RESULT_LOST = 3,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum rungc_feed_result rungc_feed_result;
#else
typedef uint8_t rungc_feed_result;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * Quantity that a channel measures or outputs.
 */
enum Quantity
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : uint8_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    /**
     * Volts.
     */
    QUANTITY_VOLTS = 0,
    /**
     * Milliamperes.
     */
    QUANTITY_MILLIAMPERES = 1,
    /**
     * Degrees Celsius.
     */
    QUANTITY_CELSIUS = 2,
    /**
     * An input terminal: 1 if it is on. Its channels count the X of the module, the first being X0.
     */
    QUANTITY_INPUT_TERMINAL = 3,
    /**
     * An output terminal: 1 if it is on. Its channels count the Y of the module, the first being Y0.
     */
    QUANTITY_OUTPUT_TERMINAL = 4,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum Quantity Quantity;
#else
typedef uint8_t Quantity;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

/**
 * The special devices of one port.
 */
typedef struct rungc_port_wiring rungc_port_wiring;

/**
 * Counters of a client's requests.
 */
typedef struct rungc_tally {
    /**
     * Requests.
     */
    uint32_t requests;
    /**
     * Answers to them.
     */
    uint32_t answers;
    /**
     * Answers that reject a request, or do not fit it.
     */
    uint32_t rejected;
} rungc_tally;

/**
 * The client of one server.
 */
typedef struct rungc_client {
    rungc_ports family;
    /**
     * The last part of the server's IP address.
     */
    uint8_t part;
    /**
     * The request of `row` is not answered yet.
     */
    bool waits;
    /**
     * The row in work, or the next one.
     */
    uint16_t row;
    uint16_t transaction;
    /**
     * Start of the wait: for an answer, for the connection, or for the next attempt to open it.
     */
    uint32_t since_us;
    /**
     * Number of characters in `received`.
     */
    uint16_t length;
    uint8_t received[RUNGC_LONGEST_ANSWER];
    /**
     * Counters of its requests.
     */
    struct rungc_tally tally;
} rungc_client;

/**
 * A row of the table.
 */
typedef struct rungc_client_row {
    /**
     * M, S, T or C: the row works while this device is on.
     */
    rungc_class trigger;
    /**
     * The number of that device.
     */
    uint32_t number;
    /**
     * The addressed unit, 1 for most servers.
     */
    uint8_t unit;
    /**
     * The function: 01 to 06, 0F, 10.
     */
    uint8_t function;
    /**
     * The first address in the server.
     */
    uint16_t address;
    /**
     * Number of coils or registers.
     */
    uint16_t count;
    /**
     * Number of the first register D that is sent or filled; coils are sixteen to a register.
     */
    uint32_t buffer;
} rungc_client_row;

/**
 * Devices that are side by side in the program's struct.
 */
typedef struct rungc_area {
    /**
     * Their class.
     */
    rungc_class class_;
    /**
     * Type of each device.
     */
    rungc_area_kind kind;
    /**
     * First number.
     */
    uint32_t first;
    /**
     * Number of devices.
     */
    uint32_t count;
    /**
     * Distance between consecutive devices in memory, in numbers: 1, or more in an array of this many columns, each as
     * long as the longest has to be.
     */
    uint32_t columns;
    /**
     * Number of columns stored: the first ones.
     */
    uint32_t stored_columns;
    /**
     * Offset in the struct, in bytes.
     */
    size_t offset;
} rungc_area;

/**
 * Numbers that the model has, stored or not.
 */
typedef struct rungc_range {
    /**
     * Class.
     */
    rungc_class class_;
    /**
     * First number.
     */
    uint32_t first;
    /**
     * Last number.
     */
    uint32_t last;
} rungc_range;

/**
 * A special register that is another name of an index register.
 */
typedef struct rungc_alias {
    /**
     * Number of the register D.
     */
    uint32_t number;
    /**
     * Class of the index register.
     */
    rungc_class class_;
    /**
     * Its number.
     */
    uint32_t index;
} rungc_alias;

/**
 * A text of the program.
 */
typedef struct rungc_text {
    /**
     * Its characters.
     */
    const uint8_t *bytes;
    /**
     * Number of characters.
     */
    size_t length;
} rungc_text;

/**
 * Location of a serial port in a program's struct.
 */
typedef struct rungc_port_place {
    /**
     * Its special devices.
     */
    const struct rungc_port_wiring *wiring;
    /**
     * Offset in the struct.
     */
    size_t offset;
    /**
     * Characters of the longest frame.
     */
    uint16_t length;
    /**
     * Its number in the model's manual.
     */
    uint8_t number;
    /**
     * True if there is memory for the progress of its protocols.
     */
    bool has_progress;
    /**
     * True if there is memory for the state of its protocols.
     */
    bool keeps;
} rungc_port_place;

/**
 * Layout of a program's struct. All pointers are valid for their counts, for as long as the program runs.
 */
typedef struct rungc_layout {
    /**
     * Areas, sorted by class and first number.
     */
    const struct rungc_area *areas;
    /**
     * Number of areas.
     */
    size_t area_count;
    /**
     * Ranges of devices that the model has, sorted likewise.
     */
    const struct rungc_range *ranges;
    /**
     * Number of ranges.
     */
    size_t range_count;
    /**
     * Index registers with a second name.
     */
    const struct rungc_alias *aliases;
    /**
     * Number of aliases.
     */
    size_t alias_count;
    /**
     * Texts.
     */
    const struct rungc_text *texts;
    /**
     * Number of texts.
     */
    size_t text_count;
    /**
     * Offset of its `plc_sys`.
     */
    size_t sys;
    /**
     * Offset of its `plc_error`; 0 if it has none.
     */
    size_t error;
    /**
     * Offset of its `plc_on_error *`; 0 if it has none.
     */
    size_t on_error;
    /**
     * Offset of its private memories.
     */
    size_t states;
    /**
     * Number of private memories; slots are numbered from 1.
     */
    uint16_t state_count;
    /**
     * True if a 32-bit access to Zn takes Vn as its high word.
     */
    bool z_pairs_with_v;
    /**
     * Relay that shows an operation error.
     */
    uint16_t error_relay;
    /**
     * Code of an error in an operand's value.
     */
    uint16_t value_error;
    /**
     * True if M8004 and D8004 show errors of ports.
     */
    bool sums_up_ports;
    /**
     * True if errors enter the log.
     */
    bool logs_errors;
    /**
     * Offset of its pulse outputs.
     */
    size_t axes;
    /**
     * Their numbers Y, in order.
     */
    const uint8_t *outputs;
    /**
     * Number of pulse outputs.
     */
    size_t output_count;
    /**
     * The pulse outputs that the model has.
     */
    rungc_pulses pulses;
    /**
     * Its serial ports, in the order of their numbers.
     */
    const struct rungc_port_place *ports;
    /**
     * Number of serial ports.
     */
    size_t port_count;
    /**
     * Devices served by Modbus, and the limits of a frame; NULL if no port speaks it.
     */
    const rungc_modbus_profile *modbus;
    /**
     * Implementations of the ports' protocols.
     */
    const rungc_codec *const *codecs;
    /**
     * Number of protocols.
     */
    size_t codec_count;
    /**
     * The serial ports that the model has.
     */
    rungc_ports port_family;
    /**
     * Code of model and version, for partners on a line.
     */
    uint16_t type_code;
} rungc_layout;

/**
 * A moment of the real-time clock.
 */
typedef struct rungc_clock {
    /**
     * Four digits.
     */
    uint16_t year;
    /**
     * 1 to 12.
     */
    uint8_t month;
    /**
     * 1 to 31.
     */
    uint8_t day;
    /**
     * 0 to 23.
     */
    uint8_t hour;
    /**
     * 0 to 59.
     */
    uint8_t minute;
    /**
     * 0 to 59.
     */
    uint8_t second;
    /**
     * 0 = Sunday to 6 = Saturday.
     */
    uint8_t weekday;
} rungc_clock;

/**
 * The format of characters on a line.
 */
typedef struct rungc_line_format {
    /**
     * Bits per second; 0 before the port has been set up.
     */
    uint32_t bits_per_second;
    /**
     * 7 or 8.
     */
    uint8_t data_bits;
    /**
     * The bit after them.
     */
    rungc_parity parity;
    /**
     * 1 or 2.
     */
    uint8_t stop_bits;
    /**
     * Sends and receives by turns, on one pair of wires (RS-485): the driver is on while it sends, and what comes then is not received.
     */
    bool half_duplex;
} rungc_line_format;

/**
 * A character that came in.
 */
typedef struct rungc_received {
    /**
     * Time of its last bit: microseconds since power-on, wrapping.
     */
    uint32_t at_us;
    /**
     * Its value.
     */
    uint8_t byte;
    /**
     * Fault of the character.
     */
    rungc_char_fault fault;
} rungc_received;

/**
 * A frame on a CAN bus.
 */
typedef struct rungc_can_frame {
    /**
     * The identifier; bit 31 marks one of 29 bits.
     */
    uint32_t id;
    /**
     * Number of data bytes.
     */
    uint8_t len;
    /**
     * The data; 0 after its end.
     */
    uint8_t data[8];
} rungc_can_frame;

/**
 * The hardware that instructions ask, as functions; one that is `NULL` means "not fitted". `context` is handed to each.
 */
typedef struct rungc_hal {
    /**
     * The host's own.
     */
    void *context;
    /**
     * Reads the real-time clock; false if there is none.
     */
    bool (*clock)(void *context, struct rungc_clock *clock);
    /**
     * Sets the real-time clock; false if that failed.
     */
    bool (*set_clock)(void *context, const struct rungc_clock *clock);
    /**
     * Reads a word of the buffer memory of a module; false if there is none.
     */
    bool (*read_bfm)(void *context, uint16_t unit, uint16_t address, int16_t *value);
    /**
     * Writes a word of the buffer memory of a module; false if there is none.
     */
    bool (*write_bfm)(void *context, uint16_t unit, uint16_t address, int16_t value);
    /**
     * Waits until a remote module (101 to 163) answers, for this many milliseconds at most; false if it has not.
     * `NULL`: only its buffer memory shows whether it is there.
     */
    bool (*module_answers)(void *context, uint16_t unit, uint16_t most_ms);
    /**
     * Raw value of a built-in analog input; false if there is none.
     */
    bool (*analog)(void *context, uint8_t channel, int16_t *value);
    /**
     * Reads an input terminal now; false if there is none.
     */
    bool (*input)(void *context, uint16_t number, bool *on);
    /**
     * Sets an output terminal now.
     */
    void (*set_output)(void *context, uint16_t number, bool on);
    /**
     * Keeps the interrupt from coming that calls the program's `pulse_timer`, or lets it come again.
     */
    void (*hold_pulses)(void *context, bool hold);
    /**
     * Sets the format of characters on the line of a serial port, before anything else and when it changes.
     */
    void (*set_line)(void *context, uint8_t port, const struct rungc_line_format *format);
    /**
     * Takes the oldest character that was in by `now_us`, microseconds since power-on, wrapping; false if there is none.
     */
    bool (*receive)(void *context, uint8_t port, uint32_t now_us, struct rungc_received *received);
    /**
     * Takes a character to be sent after those before it; false if there is no room for it now.
     */
    bool (*send)(void *context, uint8_t port, uint8_t byte, uint32_t now_us);
    /**
     * Number of those characters that are not out by `now_us`, to the end of their stop bits.
     */
    uint16_t (*unsent)(void *context, uint8_t port, uint32_t now_us);
    /**
     * Takes the oldest frame that has come by CAN; false if there is none.
     */
    bool (*can_receive)(void *context, struct rungc_can_frame *frame);
    /**
     * Takes a frame to be sent by CAN after those before it; false if there is no room for it now.
     */
    bool (*can_send)(void *context, const struct rungc_can_frame *frame);
    /**
     * Returns true while frames taken by `can_send` are not on the bus yet; `NULL`: never.
     */
    bool (*can_is_sending)(void *context);
    /**
     * Returns true if the power supply fails now; `NULL`: it is not monitored.
     */
    bool (*power_fails)(void *context);
    /**
     * Voltage of the battery in tenths of a volt; false if nothing measures it.
     */
    bool (*battery)(void *context, uint16_t *tenths);
} rungc_hal;

/**
 * Private memory of one instruction in the program (RAMP's progress, HKY's scan position, …), zero at power-on.
 */
typedef struct rungc_state {
    int32_t _0[8];
} rungc_state;

/**
 * A program's devices: its struct, what it looks like, and the hardware.
 */
typedef struct rungc_map {
    /**
     * Layout of the struct.
     */
    const struct rungc_layout *layout;
    /**
     * The struct. Nothing else may use it during a call.
     */
    void *plc;
    /**
     * The hardware; `NULL`: nothing fitted.
     */
    const struct rungc_hal *hal;
    /**
     * Taken by instructions without private memory.
     */
    struct rungc_state none;
} rungc_map;

/**
 * The answer to a request.
 */
typedef struct rungc_reply {
    /**
     * RUN or STOP, if the request asks for it.
     */
    rungc_request request;
    /**
     * RUN or STOP, if the request switches the PLC to it, by a command or by special relays.
     */
    rungc_request switched;
    /**
     * Length in characters; 0: the request is not answered.
     */
    uint16_t length;
    /**
     * Its characters.
     */
    uint8_t bytes[RUNGC_LONGEST_REPLY];
} rungc_reply;

/**
 * The position of a call in the program.
 */
typedef struct rungc_site {
    /**
     * Step number, reported in D8069 if the instruction faults.
     */
    uint32_t step;
    /**
     * Number of its [`State`]; 0 for instructions without.
     */
    uint16_t slot;
    /**
     * 32-bit form.
     */
    bool wide;
    /**
     * True if the drive contact is on. Only instructions that [`crate::Needs::always`] run are called with `false`.
     */
    bool drive;
    /**
     * An input has changed that the instruction looks at, perhaps between two scans: it is driven as it was last ([`crate::Needs::signals`]).
     */
    bool signal;
    /**
     * Period in milliseconds of the timer interrupt whose routine executes the instruction, if it takes its time from
     * that ([`crate::Needs::sampled`]); else 0.
     */
    uint16_t period_ms;
} rungc_site;

/**
 * An operand, its index register already added.
 */
typedef struct rungc_operand {
    /**
     * Interpretation of `value`.
     */
    rungc_operand_kind kind;
    /**
     * Device class, where it is a device.
     */
    rungc_class class_;
    /**
     * Digits of a group, the bit of a word, or the number of a module.
     */
    uint8_t digits;
    /**
     * Hint for the area that stores the device in emitted C, counted from the last, which is 1. It is looked at first;
     * 0, or an area that does not hold the device: it is searched by its number.
     */
    uint8_t area;
    /**
     * Device number, address, constant, or bits of a float.
     */
    int32_t value;
} rungc_operand;

/**
 * A special module at work. It is not to be copied, and takes no call before rungc_module_fit.
 */
typedef struct rungc_module {
    /**
     * Room for it.
     */
    uint64_t words[256];
} rungc_module;

/**
 * Callbacks of a host for connections: `input_edge` receives changes of inputs, `output` returns the state of an
 * output terminal. Both are given `context`; `input_edge` may be NULL.
 */
typedef struct rungc_terminal {
    /**
     * Argument passed to the functions.
     */
    void *context;
    /**
     * An input terminal turns on or off.
     */
    void (*input_edge)(void *context, uint32_t number, bool on);
    /**
     * The state of an output terminal.
     */
    bool (*output)(void *context, uint32_t number);
} rungc_terminal;

/**
 * Protocol of a server, for a model.
 */
typedef struct rungc_service {
    /**
     * Its protocol.
     */
    rungc_server_protocol protocol;
    /**
     * The model's family.
     */
    rungc_ports family;
    /**
     * Code of model and version, which D8001 shows.
     */
    uint16_t type_code;
} rungc_service;

/**
 * State of a slave between frames: the monitor list of the programming port, or the blocks of QLink. A port speaks one
 * protocol at a time, so they share it. All zero is nothing.
 */
typedef struct rungc_memory {
    uint8_t _0[RUNGC_MEMORY_SIZE];
} rungc_memory;

/**
 * A connection to a server: what has come of a request, and what is kept from one to the next.
 */
typedef struct rungc_connection {
    struct rungc_service service;
    /**
     * Number of characters in `received`.
     */
    uint16_t length;
    /**
     * It is a request that is over.
     */
    bool over;
    /**
     * Modes before and after the last request: the PLC is in RUN, or goes there.
     */
    bool ran;
    bool runs;
    uint8_t received[RUNGC_LONGEST_REQUEST];
    struct rungc_memory memory;
} rungc_connection;

/**
 * One pulse output. All zero is one that is idle.
 */
typedef struct rungc_generator {
    /**
     * Progress of the present pulse.
     */
    uint64_t phase;
    /**
     * Progress of a whole pulse.
     */
    uint64_t full;
    /**
     * Square of the speed.
     */
    uint64_t square;
    uint64_t lowest;
    uint64_t up;
    uint64_t down;
    /**
     * Progress per microsecond.
     */
    uint32_t rate;
    uint32_t speed;
    uint32_t total;
    uint32_t sent;
    /**
     * Reading of the clock at the last call.
     */
    uint32_t now_us;
    /**
     * On-time of a pulse.
     */
    uint32_t on;
    bool busy;
    bool reverse;
    /**
     * The train was stopped before its end.
     */
    bool stopped;
    /**
     * A signal of a fixed width and period.
     */
    bool modulates;
    /**
     * It has begun, and no pin shows it yet.
     */
    bool fresh;
} rungc_generator;

/**
 * A pulse output in a program's memory. All zero is one that is idle.
 */
typedef struct rungc_axis {
    /**
     * Generator of its pulses.
     */
    struct rungc_generator generator;
    /**
     * Pulses sent on the output of this number since power-on; those sent in reverse count down.
     */
    int32_t sent;
    /**
     * The output on which it sends; another one than its own if it is an axis that is bound to that.
     */
    uint16_t output;
    /**
     * The pair of registers D in which the pulses of this train are counted; 0: none.
     */
    uint16_t counter;
    /**
     * Private memory of the instruction that sends; 0: none.
     */
    uint16_t owner;
    /**
     * A train was sent to its end, and no instruction has queried it yet.
     */
    bool ended;
    /**
     * A train was sent to its end, and pulses have not been counted since.
     */
    bool completed;
    /**
     * The program has taken over what an interrupt sent on it, and not given it back yet.
     */
    bool taken;
    /**
     * True if the pin is on.
     */
    bool on;
    /**
     * True if the pin is inverted: on where a pulse is off.
     */
    bool inverted;
    /**
     * Pulses that have ended, but are not counted in registers yet.
     */
    int32_t uncounted;
    /**
     * A timer drives the pin, whose time is another than that of scans.
     */
    bool timed;
} rungc_axis;



/**
 * All of them, by their numbers.
 */
#define Quantity_ALL { Quantity_Volts, Quantity_Milliamperes, Quantity_Celsius, Quantity_InputTerminal, Quantity_OutputTerminal, }

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * The client of a server whose IP address ends in `part` begins.
 */
void rungc_client_begin(struct rungc_client *client, rungc_ports family, uint8_t part);

/**
 * Next action of a client, `now_us` microseconds after an arbitrary origin; a request to be sent is in `request`.
 * `rows` are the `count` rows of the server, the same in each call. Call it between two scans.
 */
rungc_client_action rungc_client_next(struct rungc_client *client,
                                      const struct rungc_client_row *rows,
                                      uint16_t count,
                                      rungc_link link,
                                      uint32_t now_us,
                                      struct rungc_map *map,
                                      struct rungc_reply *request);

/**
 * Takes a character that has come; `RUNGC_CLIENT_ACTION_CLOSE` if nothing that follows can be an answer.
 */
rungc_client_action rungc_client_feed(struct rungc_client *client,
                                      const struct rungc_client_row *rows,
                                      uint16_t count,
                                      uint8_t byte,
                                      uint32_t now_us,
                                      struct rungc_map *map);

/**
 * The connection could not be opened, or has been closed by the server.
 */
void rungc_client_lost(struct rungc_client *client, uint32_t now_us, struct rungc_map *map);

/**
 * The value of an operand, of the width of the form; false after a fault, which is shown in the program's special devices.
 */
bool rungc_fetch(struct rungc_map *map,
                 struct rungc_site site,
                 struct rungc_operand from,
                 int32_t *value);

/**
 * Writes a value of the width of the form to an operand, as an instruction does.
 */
void rungc_send(struct rungc_map *map, struct rungc_site site, struct rungc_operand to, int32_t value);

/**
 * State of a bit device, for hosts that find devices by number; false if the model has none of that number.
 */
bool rungc_get_bit(const struct rungc_map *map, rungc_class class_, uint32_t number, bool *on);

/**
 * Sets a bit device.
 */
bool rungc_set_bit(struct rungc_map *map, rungc_class class_, uint32_t number, bool on);

/**
 * Value of a 16-bit word device.
 */
bool rungc_get_word(const struct rungc_map *map, rungc_class class_, uint32_t number, int16_t *value);

/**
 * Sets a 16-bit word device.
 */
bool rungc_set_word(struct rungc_map *map, rungc_class class_, uint32_t number, int16_t value);

/**
 * The 32-bit value of a counter from C200 on or of a pair of words, as 32-bit instructions see it.
 */
bool rungc_get_long(struct rungc_map *map, rungc_class class_, uint32_t number, int32_t *value);

/**
 * Counts the pulses that have been sent by `now_us`, in microseconds since power-on, wrapping.
 */
void rungc_advance_pulses(struct rungc_map *map, uint32_t now_us);

/**
 * Counts the pulses that are sent from `from_us` to `until_us`, in microseconds since power-on, wrapping, but only until an output has sent
 * `most`; returns the time that is reached. For simulators, whose machines change an input at the very pulse.
 */
uint32_t rungc_pass_pulses(struct rungc_map *map,
                           uint32_t from_us,
                           uint32_t until_us,
                           uint32_t most);

/**
 * Brings the serial ports to `now_us`, microseconds since power-on, wrapping.
 */
rungc_request rungc_advance_ports(struct rungc_map *map, uint32_t now_us);

/**
 * Drives the pins of all pulse outputs at `now_us`; returns after how many microseconds the next one changes, `UINT32_MAX` if none does.
 */
uint32_t rungc_pulse_timer(struct rungc_map *map,
                           uint32_t now_us);

/**
 * Pulses that output Y `number` has sent since power-on; those in reverse count down.
 */
int32_t rungc_pulses_sent(struct rungc_map *map, uint32_t number);

/**
 * The frequency at which output Y `number` sends pulses now, in millihertz.
 */
uint32_t rungc_pulse_millihertz(struct rungc_map *map, uint32_t number);

/**
 * Sets the 32-bit value of a counter from C200 on or of a pair of words.
 */
bool rungc_set_long(struct rungc_map *map, rungc_class class_, uint32_t number, int32_t value);

/**
 * Puts a module of a kind, by its number in the table of kinds, as it comes from the factory; false if there is no
 * such kind.
 */
bool rungc_module_fit(struct rungc_module *module, uint16_t kind);

/**
 * Connects a signal to a channel; channels are counted from 0, and the signal is in millionths of a volt (quantity 0),
 * of a milliampere (1) or of a degree Celsius (2). False if there is no such input.
 */
bool rungc_module_connect(struct rungc_module *module, uint8_t channel, uint8_t quantity, int32_t millionths);

/**
 * Output signal of a channel, in millionths of that unit; 0 if it outputs no such quantity.
 */
int32_t rungc_module_signal(struct rungc_module *module, uint8_t channel, uint8_t quantity);

/**
 * Microseconds pass: the module converts its inputs.
 */
void rungc_module_pass(struct rungc_module *module, uint32_t microseconds);

/**
 * Reads a word of buffer memory; false if the module does not have that many.
 */
bool rungc_module_read(struct rungc_module *module, uint16_t address, int16_t *value);

/**
 * Writes a word of buffer memory; false if the module does not have that many.
 */
bool rungc_module_write(struct rungc_module *module, uint16_t address, int16_t value);

/**
 * `--io FILE`: reads the connections that a file describes; false after a message if it cannot be used.
 */
bool rungc_io_describe(const char *program, const char *path);

/**
 * `--log FILE`: begins or continues a log; false after a message if it cannot be written.
 */
bool rungc_io_open_log(const char *program, const char *path);

/**
 * Adds a line to the log, if there is one.
 */
void rungc_io_log(const char *line);

/**
 * Returns true if a connection reads standard input, which leaves none for commands.
 */
bool rungc_io_uses_stdin(void);

/**
 * Starts the connections, before the first scan; false after a message if that cannot be done.
 */
bool rungc_io_begin(const char *program, const struct rungc_map *map);

/**
 * Before a scan: devices take what the other ends have given, or what they are to be while an end is lost.
 */
void rungc_io_read_inputs(struct rungc_map *map, const struct rungc_terminal *terminal);

/**
 * After a scan: the other ends are given what the devices are.
 */
void rungc_io_write_outputs(struct rungc_map *map, const struct rungc_terminal *terminal);

/**
 * The run is over: outputs are turned off, and the log is written.
 */
void rungc_io_end(void);

/**
 * A connection begins.
 */
void rungc_connect(struct rungc_connection *connection, struct rungc_service service);

/**
 * Takes a character that has come over a connection. If it is the last of a request, that is carried out and answered
 * in `reply`. Call it between two scans.
 */
rungc_feed_result rungc_feed(struct rungc_connection *connection,
                             struct rungc_map *map,
                             uint8_t byte,
                             struct rungc_reply *reply);

/**
 * Returns true if a request has begun over a connection, and is not whole.
 */
bool rungc_is_receiving(const struct rungc_connection *connection);

/**
 * Returns true if a PLC of this family is in RUN, or goes there when the next scan begins, and stays there.
 */
bool rungc_will_run(struct rungc_map *map, rungc_ports family);

/**
 * Returns true if a frame is being sent over a port, or waits to be.
 */
bool rungc_is_answering(struct rungc_map *map, uint8_t port);

/**
 * The virtual hardware as instructions see it, for `Map::hal`.
 */
struct rungc_hal rungc_virtual_hal(void);

/**
 * Virtual hardware as new: without modules, at virtual time 0.
 */
void rungc_virtual_reset(void);

/**
 * Selects the PLC, 0 for the first, that the following calls are for; false if there are not so many.
 */
bool rungc_virtual_select(uint32_t plc);

/**
 * A character comes to a serial port; `fault` is a number of rungc_char_fault. False if too many are on their way.
 */
bool rungc_virtual_receive(uint8_t port, uint32_t at_us, uint8_t byte, uint8_t fault);

/**
 * Takes the oldest character that a serial port has sent by `now_us`: its time, shifted left by 8, plus the character.
 */
bool rungc_virtual_sent(uint8_t port, uint32_t now_us, int64_t *sent);

/**
 * The format of characters on the line of a serial port.
 */
bool rungc_virtual_line(uint8_t port, int64_t *format);

/**
 * Virtual time begins at 0 again, as after power off and on.
 */
void rungc_virtual_restart(void);

/**
 * Virtual time is now `now_ms`; before each scan.
 */
void rungc_virtual_advance(uint32_t now_ms);

/**
 * Sets a word of buffer memory, fitting the module if need be; false if the table is full.
 */
bool rungc_virtual_set_bfm(uint16_t unit, uint16_t address, int16_t value);

/**
 * A word of buffer memory; false if there is no such module.
 */
bool rungc_virtual_get_bfm(uint16_t unit, uint16_t address, int16_t *value);

/**
 * Fits a special module, by its number in the table of kinds; false if there is no such kind or no place for it.
 */
bool rungc_virtual_fit(uint16_t unit, uint16_t kind);

/**
 * A module answers after this many milliseconds from now on; false if too many are slow.
 */
bool rungc_virtual_delay_module(uint16_t unit, uint16_t ms);

/**
 * The RUN/STOP switch, as modules see it.
 */
void rungc_virtual_set_running(bool running);

/**
 * Connects a signal to an input of a module, in millionths of a volt (quantity 0), of a milliampere (1) or of a degree
 * Celsius (2). False if there is no such input.
 */
bool rungc_virtual_set_signal(uint16_t unit, uint8_t channel, uint8_t quantity, int32_t millionths);

/**
 * Signal at a channel of a module, in millionths of that unit; false if there is no such channel.
 */
bool rungc_virtual_get_signal(uint16_t unit, uint8_t channel, uint8_t quantity, int32_t *millionths);

/**
 * Sets the raw value of an analog input; false if there is no such channel.
 */
bool rungc_virtual_set_analog(uint8_t channel, int16_t value);

/**
 * The power supply fails from now on, or is back.
 */
void rungc_virtual_set_power_fails(bool fails);

/**
 * Sets the real-time clock; false if there is no such moment.
 */
bool rungc_virtual_set_clock(uint16_t year, uint8_t month, uint8_t day, uint8_t hour, uint8_t minute, uint8_t second);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* RUNGC_RT_H */

#ifndef RUNGC_RT_OPERANDS_H
#define RUNGC_RT_OPERANDS_H

/* Operands as programs write them: rungc_K(5), rungc_E(1.5f), rungc_D(100), rungc_U(0, 5), rungc_group(4, rungc_M(0)), rungc_bit_of(rungc_D(0), 15). */
static inline rungc_operand rungc_device(rungc_class device_class, int32_t number)
{
    rungc_operand operand;
    operand.kind = RUNGC_OPERAND_KIND_DEVICE;
    operand.class_ = device_class;
    operand.digits = 0;
    operand.area = 0;
    operand.value = number;
    return operand;
}

/* An operand whose device is in this area of the program's layout, counted from the last: rungc_in(1, rungc_D(100)). */
static inline rungc_operand rungc_in(uint8_t area, rungc_operand device)
{
    device.area = area;
    return device;
}

static inline rungc_operand rungc_K(int32_t value)
{
    rungc_operand operand = rungc_device(RUNGC_CLASS_D, value);
    operand.kind = RUNGC_OPERAND_KIND_CONST;
    return operand;
}

static inline rungc_operand rungc_E(float value)
{
    rungc_operand operand = rungc_device(RUNGC_CLASS_D, plc_float_bits(value));
    operand.kind = RUNGC_OPERAND_KIND_FLOAT;
    return operand;
}

static inline rungc_operand rungc_string(int32_t number)
{
    rungc_operand operand = rungc_device(RUNGC_CLASS_D, number);
    operand.kind = RUNGC_OPERAND_KIND_TEXT;
    return operand;
}

static inline rungc_operand rungc_group(uint8_t digits, rungc_operand first)
{
    first.kind = RUNGC_OPERAND_KIND_NIBBLES;
    first.digits = digits;
    return first;
}

static inline rungc_operand rungc_bit_of(rungc_operand word, uint8_t bit)
{
    word.kind = RUNGC_OPERAND_KIND_WORD_BIT;
    word.digits = bit;
    return word;
}

static inline rungc_operand rungc_U(uint8_t module, int32_t address)
{
    rungc_operand operand = rungc_device(RUNGC_CLASS_D, address);
    operand.kind = RUNGC_OPERAND_KIND_BUFFER;
    operand.digits = module;
    return operand;
}

static inline rungc_operand rungc_X(int32_t number)
{
    return rungc_device(RUNGC_CLASS_X, number);
}

static inline rungc_operand rungc_Y(int32_t number)
{
    return rungc_device(RUNGC_CLASS_Y, number);
}

static inline rungc_operand rungc_M(int32_t number)
{
    return rungc_device(RUNGC_CLASS_M, number);
}

static inline rungc_operand rungc_S(int32_t number)
{
    return rungc_device(RUNGC_CLASS_S, number);
}

static inline rungc_operand rungc_T(int32_t number)
{
    return rungc_device(RUNGC_CLASS_T, number);
}

static inline rungc_operand rungc_C(int32_t number)
{
    return rungc_device(RUNGC_CLASS_C, number);
}

static inline rungc_operand rungc_D(int32_t number)
{
    return rungc_device(RUNGC_CLASS_D, number);
}

static inline rungc_operand rungc_R(int32_t number)
{
    return rungc_device(RUNGC_CLASS_R, number);
}

static inline rungc_operand rungc_V(int32_t number)
{
    return rungc_device(RUNGC_CLASS_V, number);
}

static inline rungc_operand rungc_Z(int32_t number)
{
    return rungc_device(RUNGC_CLASS_Z, number);
}

static inline rungc_operand rungc_ER(int32_t number)
{
    return rungc_device(RUNGC_CLASS_ER, number);
}

/* Location of a call: the step, shown in D8069 if the instruction fails; `wide` for the 32-bit form. */
static inline rungc_site rungc_at(uint32_t step)
{
    rungc_site site;
    (void)memset(&site, 0, sizeof site);
    site.step = step;
    site.drive = true;
    return site;
}

static inline rungc_site rungc_wide_at(uint32_t step)
{
    rungc_site site = rungc_at(step);
    site.wide = true;
    return site;
}

#endif /* RUNGC_RT_OPERANDS_H */

/* INSTRUCTIONS */
