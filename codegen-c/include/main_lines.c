/* After how many microseconds it is tried again to open a line that has vanished. */
#define RETRY_US 1000000u

/* A serial port of the program, and the one of this machine that it is. */
typedef struct {
    const uint8_t port; /* its number in the PLC's manual */
    int file;           /* -1: none */
    int client_end;     /* of a pseudo-terminal: open, so that clients can come and go */
    const char *path;
    rungc_line_format format;
    uint32_t character_us; /* duration of a character */
    uint32_t received_us;  /* time of the last received character */
    uint32_t sent_us;      /* end of the last sent character */
    uint8_t received[1024];
    size_t next, count; /* the next of them, and how many there are */
    uint8_t to_send[600];
    size_t waiting;
    uint32_t tried_us; /* last attempt to reopen the line */
} serial_line;

static serial_line serial_lines[] = {
    /* LINES */
};

/* True while the program receives characters: between two scans. */
static bool lines_receive;

static serial_line *line_of(uint8_t port)
{
    for (size_t i = 0; i < sizeof serial_lines / sizeof serial_lines[0]; i++) {
        if (serial_lines[i].port == port) {
            return &serial_lines[i];
        }
    }
    return NULL;
}

/* The line has vanished; the program runs on without it. */
static void close_line(serial_line *line)
{
    print(stderr, "PROGRAM: COM%u: %s is gone; waiting for it\n", line->port, line->path);
    close(line->file);
    line->file = -1;
    line->waiting = 0;
    line->next = 0;
    line->count = 0;
}

static speed_t speed_of(uint32_t bits_per_second)
{
    static const struct {
        uint32_t bits_per_second;
        speed_t speed;
    } speeds[] = {
        {300, B300},     {600, B600},     {1200, B1200},   {2400, B2400},   {4800, B4800},
        {9600, B9600},   {19200, B19200}, {38400, B38400}, {57600, B57600}, {115200, B115200},
    };

    for (size_t i = 0; i < sizeof speeds / sizeof speeds[0]; i++) {
        if (speeds[i].bits_per_second == bits_per_second) {
            return speeds[i].speed;
        }
    }
    return B9600;
}

/* The line has the format that the program sets up. */
static void set_line(void *context, uint8_t port, const rungc_line_format *format)
{
    serial_line *const line = line_of(port);
    struct termios settings;

    (void)context;
    if (line == NULL || line->file < 0 || format->bits_per_second == 0u) {
        return;
    }
    const uint32_t bits = 1u + format->data_bits + (format->parity != RUNGC_PARITY_NONE ? 1u : 0u) + format->stop_bits;
    line->format = *format;
    line->character_us = bits * 1000000u / format->bits_per_second;
    if (tcgetattr(line->file, &settings) != 0) {
        return;
    }
    cfmakeraw(&settings);
    settings.c_cflag &= ~(tcflag_t)(CSIZE | PARENB | PARODD | CSTOPB | CRTSCTS);
    settings.c_cflag |= (tcflag_t)(CLOCAL | CREAD | (format->data_bits == 7u ? CS7 : CS8));
    if (format->parity != RUNGC_PARITY_NONE) {
        settings.c_cflag |= (tcflag_t)(PARENB | (format->parity == RUNGC_PARITY_ODD ? PARODD : 0));
    }
    if (format->stop_bits == 2u) {
        settings.c_cflag |= (tcflag_t)CSTOPB;
    }
    cfsetispeed(&settings, speed_of(format->bits_per_second));
    cfsetospeed(&settings, speed_of(format->bits_per_second));
    if (tcsetattr(line->file, TCSANOW, &settings) != 0) {
        print(stderr, "PROGRAM: COM%u: the line cannot be set to %lu bit/s\n", port, (unsigned long)format->bits_per_second);
    }
}

/* Opens a serial port; -1 if that fails, or another kind of file is at the path. */
static int open_terminal(const char *path)
{
    struct termios settings;
    const int file = open(path, O_RDWR | O_NOCTTY | O_NONBLOCK);

    if (file >= 0 && tcgetattr(file, &settings) != 0) {
        const int why = errno;
        close(file);
        errno = why;
        return -1;
    }
    return file;
}

/* Opens a line again that has vanished, if it is there. */
static void reopen_line(serial_line *line, uint32_t now_us)
{
    if (line->path == NULL || now_us - line->tried_us < RETRY_US) {
        return;
    }
    line->tried_us = now_us;
    line->file = open_terminal(line->path);
    if (line->file >= 0) {
        const rungc_line_format format = line->format;
        print(stderr, "PROGRAM: COM%u: %s is back\n", line->port, line->path);
        set_line(NULL, line->port, &format);
    }
}

/* Characters that came together came one after the other; the last of them is in now. */
static bool receive(void *context, uint8_t port, uint32_t now_us, rungc_received *received)
{
    serial_line *const line = line_of(port);

    (void)context;
    if (line == NULL || !lines_receive) {
        return false;
    }
    if (line->file < 0) {
        reopen_line(line, now_us);
    }
    if (line->file < 0) {
        return false;
    }
    if (line->next == line->count) {
        const ssize_t count = read(line->file, line->received, sizeof line->received);
        if (count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR)) {
            close_line(line);
        }
        line->next = 0;
        line->count = count > 0 ? (size_t)count : 0;
        if (count <= 0) {
            return false;
        }
    }
    const uint32_t earliest_us = line->received_us + line->character_us;
    uint32_t at_us = now_us - (uint32_t)(line->count - line->next - 1u) * line->character_us;
    if ((int32_t)(at_us - earliest_us) < 0 && (int32_t)(earliest_us - now_us) <= 0) {
        at_us = earliest_us;
    }
    received->at_us = at_us;
    received->byte = line->received[line->next++];
    received->fault = RUNGC_CHAR_FAULT_NONE;
    line->received_us = at_us;
    return true;
}

/* Hands over what waits. */
static void flush_line(serial_line *line)
{
    while (line->file >= 0 && line->waiting > 0) {
        const ssize_t count = write(line->file, line->to_send, line->waiting);
        if (count < 0 && errno != EINTR) {
            if (errno != EAGAIN) {
                close_line(line);
            }
            return;
        }
        if (count > 0) {
            line->waiting -= (size_t)count;
            memmove(line->to_send, line->to_send + count, line->waiting);
        }
    }
}

static bool send_character(void *context, uint8_t port, uint8_t byte, uint32_t now_us)
{
    serial_line *const line = line_of(port);

    (void)context;
    if (line == NULL || line->waiting == sizeof line->to_send) {
        return false;
    }
    if ((int32_t)(line->sent_us - now_us) < 0) {
        line->sent_us = now_us;
    }
    line->sent_us += line->character_us;
    line->to_send[line->waiting++] = byte;
    return true;
}

static uint16_t unsent(void *context, uint8_t port, uint32_t now_us)
{
    serial_line *const line = line_of(port);

    (void)context;
    if (line == NULL || line->file < 0) {
        return 0;
    }
    flush_line(line);
    const int32_t left_us = (int32_t)(line->sent_us - now_us);
    return (uint16_t)(left_us > 0 && line->character_us > 0u ? (uint32_t)left_us / line->character_us + 1u : line->waiting);
}

/* Reports that a partner on a serial port switches the PLC: on one that is being answered, if that is known. */
static void report_switch(rungc_map *map, bool runs)
{
    char ports[64] = "";
    bool is_known = false;

    for (size_t i = 0; i < sizeof serial_lines / sizeof serial_lines[0]; i++) {
        is_known = is_known || (serial_lines[i].path != NULL && rungc_is_answering(map, serial_lines[i].port));
    }
    for (size_t i = 0; i < sizeof serial_lines / sizeof serial_lines[0]; i++) {
        if (serial_lines[i].path != NULL && (!is_known || rungc_is_answering(map, serial_lines[i].port))) {
            const size_t length = strlen(ports);
            snprintf(ports + length, sizeof ports - length, "%sCOM%u", length == 0u ? "" : " or ", serial_lines[i].port);
        }
    }
    print(stderr, "PROGRAM: %s switches to %s\n", ports, runs ? "RUN" : "STOP");
}

/* Advances time between two scans, and has the serial ports receive and answer characters. Reports a partner that switches to RUN or STOP. */
static void advance_lines(PROGRAM_plc *plc, uint32_t now_ms)
{
    rungc_map map = PROGRAM_map(plc);
    const bool ran = rungc_will_run(&map, FAMILY);

    lines_receive = true;
    PROGRAM_tick(plc, now_ms);
    lines_receive = false;
    const bool runs = rungc_will_run(&map, FAMILY);
    if (runs != ran) {
        report_switch(&map, runs);
        partner_stops = !runs;
    }
}

/* A new pseudo-terminal, whose other end is for clients. */
static bool open_pseudo_terminal(serial_line *line)
{
    static char path[sizeof serial_lines / sizeof serial_lines[0]][64];
    char *const place = path[line - serial_lines];
    struct termios settings;

    line->file = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
    if (line->file < 0 || grantpt(line->file) != 0 || unlockpt(line->file) != 0) {
        return false;
    }
    const char *const name = ptsname(line->file);
    line->client_end = name == NULL ? -1 : open(name, O_RDWR | O_NOCTTY);
    if (line->client_end < 0 || tcgetattr(line->client_end, &settings) != 0) {
        return false;
    }
    cfmakeraw(&settings);
    snprintf(place, sizeof path[0], "%s", name);
    line->path = place;
    return tcsetattr(line->client_end, TCSANOW, &settings) == 0;
}

/* Number of ports that are listed at most: some machines have dozens without a connector. */
#define LISTED_PORTS 8u

/* Prints the serial ports of this machine, adapters first. */
static void list_ports(void)
{
    static const char *const patterns[] = {"/dev/ttyUSB*", "/dev/ttyACM*", "/dev/ttyAMA*", "/dev/cu.*", "/dev/ttyS*"};
    unsigned listed = 0;

    for (size_t i = 0; i < sizeof patterns / sizeof patterns[0]; i++) {
        glob_t found;
        if (glob(patterns[i], 0, NULL, &found) != 0) {
            continue;
        }
        for (size_t n = 0; n < found.gl_pathc && listed < LISTED_PORTS; n++) {
            listed++;
            print(stderr, "PROGRAM: this machine has %s\n", found.gl_pathv[n]);
        }
        globfree(&found);
    }
    if (listed == 0u) {
        print(stderr, "PROGRAM: this machine has no serial port: is the adapter connected?\n");
    }
}

/* Connects a serial port to `/dev/ttyUSB0` or `pty`. */
static bool connect_line(uint8_t port, const char *path)
{
    serial_line *const line = line_of(port);

    if (line == NULL) {
        print(stderr, "PROGRAM: the program has no port COM%u\n", port);
        return false;
    }
    if (line->path != NULL) {
        print(stderr, "PROGRAM: COM%u is connected to two lines\n", port);
        return false;
    }
    line->path = path;
    if (strncmp(path, "tcp:", 4) == 0 || strncmp(path, "tcp-listen:", 11) == 0) {
        print(stderr, "PROGRAM: COM%u=%s: this program has no serial lines over TCP, `rungc run` has; ", port, path);
        print(stderr, "socat joins one to a pseudo-terminal\n");
        return false;
    }
    if (strcmp(path, "pty") != 0) {
        line->file = open_terminal(path);
    }
    if (strcmp(path, "pty") == 0 ? !open_pseudo_terminal(line) : line->file < 0) {
        const bool is_missing = errno == ENOENT;
        print(stderr, "PROGRAM: COM%u=%s: %s\n", port, path, strerror(errno));
        if (is_missing) {
            list_ports();
        }
        return false;
    }
    print(stderr, "PROGRAM: COM%u at %s\n", port, line->path);
    return true;
}

/* Connects a serial port by `COM1=/dev/ttyUSB0` or `COM1=pty`. */
static bool open_line(const char *what)
{
    char *end = NULL;
    const unsigned long port = strncmp(what, "COM", 3) == 0 ? strtoul(what + 3, &end, 10) : 0;

    if (end == NULL || end == what + 3 || *end != '=' || port > 255u) {
        print(stderr, "PROGRAM: --serial %s: a line is written COM1=/dev/ttyUSB0 or COM1=pty\n", what);
        return false;
    }
    return connect_line((uint8_t)port, end + 1);
}
