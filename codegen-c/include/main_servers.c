/* Limits: servers, connections to them, and clients that the table distinguishes. */
#define SERVERS 8
#define CONNECTIONS MAX_CONNECTIONS
#define CLIENTS 64

/* Milliseconds after which a silent connection gives way to a new one if a server has no more room. */
#define IDLE_MS (IDLE_LIMIT * 1000u)

/* Milliseconds of silence after which an incomplete request ends its connection: what comes then begins another one. */
#define REQUEST_MS (REQUEST_LIMIT * 1000u)

/* Milliseconds for which input of a lost connection is dropped: closed with unread input, it would be reset, and its last answer lost. */
#define LINGER_MS 1000u

/* Bytes that one connection may have carried out between two scans. */
#define AT_ONCE 4096

/* A server over TCP. */
typedef struct {
    int listener;
    rungc_service service;
    const char *name;
    char address[80];
    size_t limit;   /* connections at once */
    bool is_full;   /* from a refusal until there is room again */
} tcp_server;

/* Traffic of a client's connections. */
typedef struct {
    size_t server;
    char address[64];
    unsigned long requests, answers, rejected, stops;
} tcp_client;

/* A connection to a server. */
typedef struct {
    int file; /* -1: none */
    bool is_lost; /* where the next request begins is unknown: it ends with the answers */
    bool is_shut; /* nothing more is sent */
    tcp_client *client;
    uint32_t last_ms; /* time of the last reception */
    rungc_connection parser;
    uint8_t to_send[2 * RUNGC_LONGEST_REPLY];
    size_t waiting;
} tcp_connection;

static tcp_server tcp_servers[SERVERS];
static size_t tcp_server_count;
static tcp_client tcp_clients[CLIENTS];
static size_t tcp_client_count;
static tcp_connection tcp_connections[CONNECTIONS];
static size_t connection_limit = USUAL_CONNECTIONS;
static uint32_t poll_ms; /* time of this poll */

/* An address as text; with its port, if there is room for one. */
static void name_address(const struct sockaddr_storage *address, socklen_t length, char *host, size_t host_size, char *both, size_t size)
{
    char port[16] = "";

    if (getnameinfo((const struct sockaddr *)address, length, host, (socklen_t)host_size, port, sizeof port, NI_NUMERICHOST | NI_NUMERICSERV) != 0) {
        snprintf(host, host_size, "?");
    }
    if (both != NULL) {
        snprintf(both, size, strchr(host, ':') == NULL ? "%s:%s" : "[%s]:%s", host, port);
    }
}

/* Parses an address, `127.0.0.1:5020` or `5020`; NULL if it is not one. */
static struct addrinfo *find_address(const char *text)
{
    const struct addrinfo hints = {.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV | AI_PASSIVE, .ai_socktype = SOCK_STREAM};
    char host[64] = "127.0.0.1";
    const char *const colon = strrchr(text, ':');
    const char *const port = colon == NULL ? text : colon + 1;
    struct addrinfo *found = NULL;
    char *end = NULL;

    if (colon != NULL) {
        const bool in_brackets = text[0] == '[' && colon > text && colon[-1] == ']';
        const char *const from = in_brackets ? text + 1 : text;
        const size_t length = (size_t)(colon - from) - (in_brackets ? 1u : 0u);
        if (length == 0u || length >= sizeof host) {
            return NULL;
        }
        memcpy(host, from, length);
        host[length] = '\0';
    }
    const unsigned long number = strtoul(port, &end, 10);
    if (port[0] < '0' || port[0] > '9' || *end != '\0' || number > 65535u || getaddrinfo(host, port, &hints, &found) != 0) {
        return NULL;
    }
    return found;
}

/* Listens at an address; false if that cannot be had. */
static bool listen_at(tcp_server *server, const struct addrinfo *at)
{
    struct sockaddr_storage address;
    socklen_t length = sizeof address;
    char host[64];
    const int on = 1;

    server->listener = socket(at->ai_family, SOCK_STREAM, 0);
    if (server->listener < 0) {
        return false;
    }
    if (setsockopt(server->listener, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) != 0 || bind(server->listener, at->ai_addr, at->ai_addrlen) != 0 ||
        listen(server->listener, CONNECTIONS) != 0 || fcntl(server->listener, F_SETFL, O_NONBLOCK) != 0 ||
        getsockname(server->listener, (struct sockaddr *)&address, &length) != 0) {
        close(server->listener);
        return false;
    }
    name_address(&address, length, host, sizeof host, server->address, sizeof server->address);
    return true;
}

/* Sets how many connections each server opened from now on has at once. */
static bool limit_connections(const char *text)
{
    char *end = NULL;
    const unsigned long limit = strtoul(text, &end, 10);

    if (text[0] < '0' || text[0] > '9' || *end != '\0' || limit == 0u || limit > CONNECTIONS) {
        print(stderr, "PROGRAM: --clients %s: a number of connections from 1 to %d\n", text, CONNECTIONS);
        return false;
    }
    connection_limit = (size_t)limit;
    return true;
}

/* Opens a server. */
static bool open_server(rungc_server_protocol protocol, const char *option, const char *name, const char *text)
{
    if (tcp_server_count == SERVERS) {
        print(stderr, "PROGRAM: at most %d servers\n", SERVERS);
        return false;
    }
    struct addrinfo *const found = find_address(text);
    if (found == NULL) {
        print(stderr, "PROGRAM: %s %s: an address is written 127.0.0.1:5020, [::1]:5020 or 5020\n", option, text);
        return false;
    }
    tcp_server *const server = &tcp_servers[tcp_server_count];
    server->service = (rungc_service){.protocol = protocol, .family = FAMILY, .type_code = TYPE_CODE};
    server->name = name;
    server->limit = connection_limit;
    const bool listens = listen_at(server, found);
    freeaddrinfo(found);
    if (!listens) {
        const char *const next = errno == EADDRINUSE ? "; the port is in use: choose another, or 0 for a free one" : "";
        print(stderr, "PROGRAM: %s %s: cannot serve %s: %s%s\n", option, text, name, strerror(errno), next);
        return false;
    }
    tcp_server_count++;
    print(stderr, "PROGRAM: %s at %s\n", name, server->address);
    return true;
}

/* The row of a client in the table; those that do not fit share the last one. */
static tcp_client *client_of(size_t server, const char *address)
{
    size_t i = 0;

    while (i < tcp_client_count && (tcp_clients[i].server != server || strcmp(tcp_clients[i].address, address) != 0)) {
        i++;
    }
    if (i == CLIENTS) {
        return &tcp_clients[CLIENTS - 1];
    }
    if (i == tcp_client_count) {
        tcp_client_count++;
        tcp_clients[i].server = server;
        snprintf(tcp_clients[i].address, sizeof tcp_clients[i].address, "%s", address);
    }
    return &tcp_clients[i];
}

static void close_connection(tcp_connection *connection)
{
    close(connection->file);
    connection->file = -1;
}

static bool is_open(const tcp_connection *connection)
{
    return connection->client != NULL && connection->file >= 0;
}

/* A place for a new connection to a server: a free one, or that of a connection which has been silent too long; NULL if there is none. */
static tcp_connection *free_connection(size_t server)
{
    tcp_connection *free = NULL;
    tcp_connection *idle = NULL;
    size_t count = 0;

    for (size_t i = 0; i < CONNECTIONS; i++) {
        tcp_connection *const connection = &tcp_connections[i];
        if (!is_open(connection)) {
            free = connection;
        } else if (connection->client->server == server) {
            const uint32_t silent_ms = poll_ms - connection->last_ms;
            count++;
            if ((connection->is_lost || silent_ms >= IDLE_MS) && (idle == NULL || silent_ms > poll_ms - idle->last_ms)) {
                idle = connection;
            }
        }
    }
    if (free != NULL && count < tcp_servers[server].limit) {
        return free;
    }
    if (idle != NULL) {
        close_connection(idle);
    }
    return idle;
}

/* Takes the connections that are waiting. */
static void accept_clients(size_t at)
{
    tcp_server *const server = &tcp_servers[at];
    struct sockaddr_storage address;
    socklen_t length = sizeof address;
    char host[64];
    const int on = 1;
    int file;

    while ((file = accept(server->listener, (struct sockaddr *)&address, &length)) >= 0) {
        name_address(&address, length, host, sizeof host, NULL, 0);
        length = sizeof address;
        if (fcntl(file, F_SETFL, O_NONBLOCK) != 0) {
            close(file);
            continue;
        }
        /* An answer is one small packet: waiting for more only delays it. */
        (void)setsockopt(file, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
        tcp_connection *const connection = free_connection(at);
        if (connection == NULL) {
            close(file);
            if (!server->is_full) {
                server->is_full = true;
                print(stderr, "PROGRAM: %s rejects %s: all %lu connections are in use (--clients allows more)\n", server->address, host, (unsigned long)server->limit);
            }
            continue;
        }
        server->is_full = false;
        connection->file = file;
        connection->is_lost = false;
        connection->is_shut = false;
        connection->client = client_of(at, host);
        connection->last_ms = poll_ms;
        connection->waiting = 0;
        rungc_connect(&connection->parser, server->service);
    }
}

/* Returns true if there is room for an answer; requests of a client that does not read are not processed. */
static bool has_room(const tcp_connection *connection)
{
    return connection->waiting <= sizeof connection->to_send - RUNGC_LONGEST_REPLY;
}

/* Takes a character, and carries out and answers the request that it ends; false if the beginning of the next request is unknown. */
static bool feed(PROGRAM_plc *plc, tcp_connection *connection, uint8_t byte)
{
    static rungc_reply reply;
    rungc_map map = PROGRAM_map(plc);
    const rungc_feed_result result = rungc_feed(&connection->parser, &map, byte, &reply);

    if (result == RUNGC_FEED_RESULT_MORE) {
        return true;
    }
    connection->client->requests++;
    connection->client->rejected += result == RUNGC_FEED_RESULT_REQUEST ? 0u : 1u;
    connection->client->answers += reply.length > 0u ? 1u : 0u;
    memcpy(connection->to_send + connection->waiting, reply.bytes, reply.length);
    connection->waiting += reply.length;
    if (reply.request != RUNGC_REQUEST_NONE) {
        PROGRAM_set_running(plc, reply.request == RUNGC_REQUEST_RUN);
    }
    if (reply.switched != RUNGC_REQUEST_NONE) {
        const bool runs = reply.switched == RUNGC_REQUEST_RUN;
        const tcp_client *const client = connection->client;
        connection->client->stops += runs ? 0u : 1u;
        print(stderr, "PROGRAM: %s switches to %s (%s)\n", client->address, runs ? "RUN" : "STOP", tcp_servers[client->server].name);
        partner_stops = !runs;
    }
    return result != RUNGC_FEED_RESULT_LOST;
}

/* Sends what the client takes; false when the connection is over. */
static bool send_answers(tcp_connection *connection)
{
    while (connection->waiting > 0) {
        const ssize_t count = send(connection->file, connection->to_send, connection->waiting, MSG_NOSIGNAL);
        if (count < 0) {
            return errno == EAGAIN || errno == EINTR;
        }
        connection->waiting -= (size_t)count;
        memmove(connection->to_send, connection->to_send + count, connection->waiting);
    }
    return true;
}

/* Ends a connection: sends the answers, and drops what still comes until the client closes it; false when it is over. */
static bool drain(tcp_connection *connection)
{
    uint8_t bytes[AT_ONCE];

    if (!send_answers(connection)) {
        return false;
    }
    if (connection->waiting == 0u && !connection->is_shut) {
        connection->is_shut = shutdown(connection->file, SHUT_WR) == 0;
    }
    const ssize_t count = recv(connection->file, bytes, sizeof bytes, 0);
    return (count > 0 || (count < 0 && (errno == EAGAIN || errno == EINTR))) && poll_ms - connection->last_ms < LINGER_MS;
}

/* Takes what has come over a connection; false when it is over. */
static bool serve(PROGRAM_plc *plc, tcp_connection *connection)
{
    bool open = true;

    for (size_t left = AT_ONCE; open && !connection->is_lost && left > 0;) {
        uint8_t bytes[512];
        const ssize_t count = recv(connection->file, bytes, sizeof bytes, MSG_PEEK);
        if (count < 0 && (errno == EAGAIN || errno == EINTR)) {
            break;
        }
        size_t taken = 0;
        open = count > 0;
        while (open && !connection->is_lost && taken < (size_t)count && has_room(connection)) {
            connection->is_lost = !feed(plc, connection, bytes[taken]);
            taken++;
        }
        if (taken == 0u) {
            break;
        }
        connection->last_ms = poll_ms;
        left -= taken < left ? taken : left;
        if (recv(connection->file, bytes, taken, 0) < 0) {
            open = false;
        }
    }
    if (rungc_is_receiving(&connection->parser) && poll_ms - connection->last_ms >= REQUEST_MS) {
        connection->client->requests++;
        connection->client->rejected++;
        connection->is_lost = true;
    }
    return connection->is_lost ? drain(connection) : send_answers(connection) && open;
}

/* Carries out and answers the requests of clients since the last scan. */
static void poll_servers(PROGRAM_plc *plc, uint32_t now_ms)
{
    poll_ms = now_ms;
    for (size_t i = 0; i < CONNECTIONS; i++) {
        tcp_connection *const connection = &tcp_connections[i];
        if (is_open(connection) && !(connection->is_lost ? drain(connection) : serve(plc, connection))) {
            close_connection(connection);
        }
    }
    for (size_t i = 0; i < tcp_server_count; i++) {
        accept_clients(i);
    }
}

/* A table of what has gone over the connections. */
static void print_connections(void)
{
    if (tcp_server_count > 0) {
        print(stderr, "HEADING\n");
    }
    for (size_t server = 0; server < tcp_server_count; server++) {
        const char *const address = tcp_servers[server].address;
        const char *const name = tcp_servers[server].name;
        bool any = false;
        for (size_t i = 0; i < tcp_client_count; i++) {
            const tcp_client *const client = &tcp_clients[i];
            if (client->server == server) {
                any = true;
                print(stderr, ROW, address, client->address, name, client->requests, client->answers, client->rejected, client->stops);
            }
        }
        if (!any) {
            print(stderr, ROW, address, "-", name, 0ul, 0ul, 0ul, 0ul);
        }
    }
}
