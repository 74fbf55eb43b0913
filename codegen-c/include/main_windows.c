/* Ctrl-C ends the run in order, and so do the end of the console, of the session and of the computer. */
static BOOL WINAPI stop(DWORD event)
{
    stopped = 1;
    if (event != CTRL_C_EVENT && event != CTRL_BREAK_EVENT) {
        /* The process ends when this returns, or a few seconds later: the run has these. */
        Sleep(INFINITE);
    }
    return TRUE;
}

static void catch_signals(void)
{
    (void)SetConsoleCtrlHandler(stop, TRUE);
}

static uint64_t microseconds(void)
{
    LARGE_INTEGER now, per_second;

    QueryPerformanceCounter(&now);
    QueryPerformanceFrequency(&per_second);
    const uint64_t count = (uint64_t)now.QuadPart, rate = (uint64_t)per_second.QuadPart;
    return count / rate * 1000000u + count % rate * 1000000u / rate;
}

#ifndef CREATE_WAITABLE_TIMER_HIGH_RESOLUTION
#define CREATE_WAITABLE_TIMER_HIGH_RESOLUTION 2
#endif

/* Windows before 10 has no timer of high resolution: it wakes up to 16 ms late. */
static void sleep_until(uint64_t moment_us)
{
    static HANDLE timer;
    const uint64_t now = microseconds();
    const uint64_t left = moment_us > now ? moment_us - now : 0u;
    const LARGE_INTEGER wait = {.QuadPart = -(LONGLONG)(left * 10u)};

    if (timer == NULL) {
        timer = CreateWaitableTimerExW(NULL, NULL, CREATE_WAITABLE_TIMER_HIGH_RESOLUTION, TIMER_ALL_ACCESS);
    }
    if (timer == NULL || !SetWaitableTimer(timer, &wait, 0, NULL, NULL, FALSE) || WaitForSingleObject(timer, INFINITE) != WAIT_OBJECT_0) {
        Sleep((DWORD)(left / 1000u));
    }
}

/* Characters from standard input, read by a thread: it sets `full`, and continues after `taken`. */
static struct {
    HANDLE full, taken;
    DWORD count; /* 0: the end of input */
    char text[512];
} input;

static DWORD WINAPI read_input(void *context)
{
    (void)context;
    do {
        if (!ReadFile(GetStdHandle(STD_INPUT_HANDLE), input.text, sizeof input.text, &input.count, NULL)) {
            input.count = 0;
        }
        SetEvent(input.full);
    } while (input.count != 0u && WaitForSingleObject(input.taken, INFINITE) == WAIT_OBJECT_0);
    return 0;
}

/* Takes what has been typed since the last call, without waiting for it. Returns the number of characters; -1 at the end of input. */
static long typed(char *text, size_t size)
{
    if (input.full == NULL) {
        input.full = CreateEventW(NULL, FALSE, FALSE, NULL);
        input.taken = CreateEventW(NULL, FALSE, FALSE, NULL);
        (void)CreateThread(NULL, 0, read_input, NULL, 0, NULL);
    }
    if (WaitForSingleObject(input.full, 0) != WAIT_OBJECT_0) {
        return 0;
    }
    const size_t count = input.count;
    if (count == 0u || count > size) {
        return -1;
    }
    memcpy(text, input.text, count);
    SetEvent(input.taken);
    return (long)count;
}
