static void stop(int signal_number)
{
    (void)signal_number;
    stopped = 1;
}

/* A signal ends the run in order, unless the caller ignores it (`nohup`). */
static void catch_signal(int number, const struct sigaction *action)
{
    struct sigaction before;

    if (sigaction(number, NULL, &before) == 0 && before.sa_handler != SIG_IGN) {
        sigaction(number, action, NULL);
    }
}

static void catch_signals(void)
{
    struct sigaction action = {.sa_flags = SA_RESTART};

    sigemptyset(&action.sa_mask);
    action.sa_handler = SIG_IGN;
    sigaction(SIGPIPE, &action, NULL);
    sigaction(SIGXFSZ, &action, NULL);
    action.sa_handler = stop;
    catch_signal(SIGHUP, &action);
    catch_signal(SIGINT, &action);
    catch_signal(SIGTERM, &action);
}

static uint64_t microseconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (uint64_t)now.tv_sec * 1000000u + (uint64_t)now.tv_nsec / 1000u;
}

static void sleep_until(uint64_t moment_us)
{
#ifdef __APPLE__
    const uint64_t now = microseconds();
    const uint64_t left = moment_us > now ? moment_us - now : 0u;
    const struct timespec wait = {.tv_sec = (time_t)(left / 1000000u), .tv_nsec = (long)(left % 1000000u) * 1000L};
    nanosleep(&wait, NULL);
#else
    const struct timespec until = {.tv_sec = (time_t)(moment_us / 1000000u), .tv_nsec = (long)(moment_us % 1000000u) * 1000L};
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, NULL);
#endif
}

/* Takes what has been typed since the last call, without waiting for it. Returns the number of characters; -1 at the end of input. */
static long typed(char *text, size_t size)
{
    struct pollfd input = {.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};

    if (poll(&input, 1, 0) <= 0) {
        return 0;
    }
    const ssize_t count = read(STDIN_FILENO, text, size);
    return count > 0 ? (long)count : -1;
}
