/* A server that the program sends requests to: `count` ones after each other. */
typedef struct {
    const char *const host, *const port;
    const uint8_t part; /* the last one of its address */
    const uint16_t first, count;
    rungc_link link;
    int file;
    rungc_client client;
} tcp_client_link;

/* Requests of the program, by servers. */
static const rungc_client_row client_rows[] = {
    /* ROWS */
};

static tcp_client_link client_links[] = {
    /* SERVERS */
};

static void begin_clients(void)
{
    for (size_t i = 0; i < sizeof client_links / sizeof client_links[0]; i++) {
        rungc_client_begin(&client_links[i].client, FAMILY, client_links[i].part);
    }
}

static void close_link(tcp_client_link *link)
{
    if (link->file >= 0) {
        close(link->file);
    }
    link->file = -1;
    link->link = RUNGC_LINK_CLOSED;
}

/* The connection could not be opened, or the server has closed it. */
static void lose_link(PROGRAM_plc *plc, tcp_client_link *link, uint32_t now_us)
{
    rungc_map map = PROGRAM_map(plc);

    close_link(link);
    rungc_client_lost(&link->client, now_us, &map);
}

/* Begins to open a connection; false if that fails at once. */
static bool open_link(tcp_client_link *link)
{
    const struct addrinfo hints = {.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV, .ai_socktype = SOCK_STREAM};
    struct addrinfo *found = NULL;
    const int on = 1;
    bool begun = false;

    if (getaddrinfo(link->host, link->port, &hints, &found) != 0) {
        return false;
    }
    link->file = socket(found->ai_family, SOCK_STREAM, 0);
    if (link->file >= 0 && fcntl(link->file, F_SETFL, O_NONBLOCK) == 0) {
        /* A request is one small packet: waiting for more only delays it. */
        (void)setsockopt(link->file, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
        begun = connect(link->file, found->ai_addr, found->ai_addrlen) == 0 || errno == EINPROGRESS;
    }
    freeaddrinfo(found);
    link->link = RUNGC_LINK_OPENING;
    return begun;
}

/* Looks whether a connection is open by now; false if it cannot be had. */
static bool has_opened(tcp_client_link *link)
{
    struct pollfd file = {.fd = link->file, .events = POLLOUT};
    int error = 0;
    socklen_t size = sizeof error;

    if (poll(&file, 1, 0) == 0) {
        return true;
    }
    if (getsockopt(link->file, SOL_SOCKET, SO_ERROR, &error, &size) != 0 || error != 0) {
        return false;
    }
    link->link = RUNGC_LINK_OPEN;
    return true;
}

/* Takes what has come over a connection; false if it is over. */
static bool receive_answers(PROGRAM_plc *plc, tcp_client_link *link, uint32_t now_us)
{
    uint8_t bytes[1024];
    rungc_map map = PROGRAM_map(plc);
    const ssize_t count = recv(link->file, bytes, sizeof bytes, 0);

    if (count < 0) {
        return errno == EAGAIN || errno == EINTR;
    }
    for (ssize_t i = 0; i < count; i++) {
        if (rungc_client_feed(&link->client, client_rows + link->first, link->count, bytes[i], now_us, &map) == RUNGC_CLIENT_ACTION_CLOSE) {
            close_link(link);
            return true;
        }
    }
    return count > 0;
}

/* Takes the answers of a server, and sends it the next request. */
static void ask(PROGRAM_plc *plc, tcp_client_link *link, uint32_t now_us)
{
    static rungc_reply request;
    rungc_map map = PROGRAM_map(plc);

    if ((link->link == RUNGC_LINK_OPENING && !has_opened(link)) || (link->link == RUNGC_LINK_OPEN && !receive_answers(plc, link, now_us))) {
        lose_link(plc, link, now_us);
    }
    switch (rungc_client_next(&link->client, client_rows + link->first, link->count, link->link, now_us, &map, &request)) {
    case RUNGC_CLIENT_ACTION_OPEN:
        if (!open_link(link)) {
            lose_link(plc, link, now_us);
        }
        break;
    case RUNGC_CLIENT_ACTION_SEND:
        /* It is shorter than any buffer of the system, so one that does not fit is the end. */
        if (send(link->file, request.bytes, request.length, MSG_NOSIGNAL) != (ssize_t)request.length) {
            lose_link(plc, link, now_us);
        }
        break;
    case RUNGC_CLIENT_ACTION_CLOSE:
        close_link(link);
        break;
    default:
        break;
    }
}

/* Takes the answers received since the last scan, and sends the next requests. */
static void poll_clients(PROGRAM_plc *plc, uint32_t now_us)
{
    for (size_t i = 0; i < sizeof client_links / sizeof client_links[0]; i++) {
        ask(plc, &client_links[i], now_us);
    }
}

/* Traffic of the connections, as for servers. */
static void print_clients(void)
{
    for (size_t i = 0; i < sizeof client_links / sizeof client_links[0]; i++) {
        const tcp_client_link *const link = &client_links[i];
        const rungc_tally *const tally = &link->client.tally;
        char address[80];
        (void)snprintf(address, sizeof address, strchr(link->host, ':') == NULL ? "%s:%s" : "[%s]:%s", link->host, link->port);
        print(stderr, ROW, address, "by PLC", "MODBUS_TCP", (unsigned long)tally->requests, (unsigned long)tally->answers,
                (unsigned long)tally->rejected);
    }
}
