/* Interval of checks for changed latched devices, and the time after which they count as not saved while the disk is busy. */
#define SAVE_EVERY_MS 1000u
#define SLOW_MS 10000u

/*
 * The file that keeps latched devices from run to run; NULL: none does. Between scans the values are put into a record, which a
 * thread writes to the file, so that no scan waits for the disk. The record and the thread's result belong to the thread from
 * `to_write` to `written`.
 */
static struct {
    const char *path;
    const char *target; /* the file that a link leads to */
    uint32_t sequence;
    uint32_t looked_ms;
    bool has_saved;
    uint32_t saved;   /* checksum of the values that were loaded or saved last */
    bool writes;      /* the thread has a record */
    uint32_t writing; /* checksum of its values */
    bool fails;       /* saving fails, which was reported */
    sem_t to_write;
    sem_t written;
    int error; /* why the thread has not written it; 0: it has */
    uint32_t length;
    uint8_t record[RECORD_LENGTH];
} retained;

static bool keep_in(const char *path)
{
    retained.path = path;
    return true;
}

static bool read_retained(void *context, uint32_t offset, void *bytes, uint32_t length)
{
    FILE *const file = context;

    return fseek(file, (long)offset, SEEK_SET) == 0 && fread(bytes, 1, length, file) == length;
}

/* Gives latched devices the values in the file, which need not exist; false if it cannot be used. */
static bool load_retained(PROGRAM_plc *plc)
{
    FILE *const file = retained.path != NULL ? fopen(retained.path, "rb") : NULL;
    const rungc_source source = {read_retained, file};
    rungc_record record = {0};
    rungc_loaded loaded = RUNGC_LOADED_FAILED;
    uint32_t dropped = 0;

    if (retained.path == NULL) {
        return true;
    }
    if (file == NULL && errno == ENOENT) {
        print(stderr, "PROGRAM: %s does not exist yet: latched devices begin as the PLC leaves the factory\n", retained.path);
        return true;
    }
    if (file == NULL) {
        print(stderr, "PROGRAM: %s: %s\n", retained.path, strerror(errno));
        return false;
    }
    const long end = fseek(file, 0, SEEK_END) == 0 ? ftell(file) : -1;
    if (end > 0 && rungc_find_record(&source, 0, (uint32_t)end, &record) && record.length != 0u) {
        loaded = rungc_restore(&PROGRAM_retained, plc, &source, &record, &dropped);
    }
    fclose(file);
    if (loaded == RUNGC_LOADED_FOREIGN) {
        print(stderr, "PROGRAM: %s holds the latched devices of `%s`, and this program is `%s`; name another file\n", retained.path, record.owner,
                PROGRAM_retained.program);
    } else if (loaded != RUNGC_LOADED_DEVICES) {
        print(stderr, "PROGRAM: %s does not hold latched devices, or is damaged\n", retained.path);
    } else if (dropped != 0u) {
        print(stderr, "PROGRAM: %s: %lu of its devices are dropped: the program does not use them as latched devices any more\n",
                retained.path, (unsigned long)dropped);
    }
    retained.sequence = record.sequence + 1u;
    retained.has_saved = dropped == 0u;
    retained.saved = rungc_retained_state(&PROGRAM_retained, plc);
    return loaded == RUNGC_LOADED_DEVICES;
}

static bool put_retained(void *context, const uint8_t *bytes, uint32_t length)
{
    (void)context;
    if (length > sizeof retained.record - retained.length) {
        return false;
    }
    memcpy(&retained.record[retained.length], bytes, length);
    retained.length += length;
    return true;
}

/* Puts the values, of which this is the checksum, into the record. */
static void record_retained(const PROGRAM_plc *plc, uint32_t state)
{
    const rungc_sink sink = {put_retained, NULL};

    retained.length = 0;
    (void)rungc_put_record(&PROGRAM_retained, plc, retained.sequence, &sink);
    retained.writing = state;
}

/* Path of the file that is locked in place of the one that is replaced; false if it is too long. */
static bool lock_path(char *path, size_t size)
{
    const int length = snprintf(path, size, "%s.lock", retained.target);

    return length >= 0 && (size_t)length < size;
}

#ifdef _WIN32
static const char *behind_links(const char *path)
{
    return path;
}

/* Locks the file until the process ends; false if another process has locked it. */
static bool lock_retained(void)
{
    char path[1024];

    if (!lock_path(path, sizeof path)) {
        return true;
    }
    const HANDLE file = CreateFileA(path, GENERIC_WRITE, 0, NULL, OPEN_ALWAYS, FILE_FLAG_DELETE_ON_CLOSE, NULL);

    return file != INVALID_HANDLE_VALUE || GetLastError() != ERROR_SHARING_VIOLATION;
}

/* Flushes a file to the disk; false with errno if that fails. */
static bool flush_file(FILE *file)
{
    return _commit(_fileno(file)) == 0;
}

/* Opens a file that does not exist yet; NULL with errno if it does. */
static FILE *open_new(const char *path)
{
    const int file = _open(path, _O_WRONLY | _O_CREAT | _O_EXCL | _O_BINARY, _S_IREAD | _S_IWRITE);

    return file < 0 ? NULL : _fdopen(file, "wb");
}

/* Opens a file to read it; NULL if it is none. */
static FILE *open_rest(const char *path)
{
    return fopen(path, "rb");
}

/* Gives a new file the name of the present one, which it replaces; false with errno if that fails. */
static bool take_name(const char *path)
{
    if (MoveFileExA(path, retained.target, MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH)) {
        return true;
    }
    errno = EACCES;
    return false;
}
#else
/* The file that a path leads to; one that is not there is the path itself. */
static const char *behind_links(const char *path)
{
    const char *const target = realpath(path, NULL);

    return target != NULL ? target : path;
}

#ifdef LOCK_EX
/* The file that is locked. */
static int lock_file;

/* Returns true if the file that is locked has this path. */
static bool is_locked(const char *path)
{
    struct stat own;
    struct stat there;

    if (fstat(lock_file, &own) != 0 || stat(path, &there) != 0) {
        return false;
    }
    return own.st_dev == there.st_dev && own.st_ino == there.st_ino;
}

/* Removes the file that is locked, as the process ends. */
static void unlock_retained(void)
{
    char path[1024];

    if (lock_path(path, sizeof path) && is_locked(path)) {
        (void)unlink(path);
    }
}

/* Locks the file until the process ends; false if another process has locked it. */
static bool lock_retained(void)
{
    char path[1024];
    int attempts = 100;

    if (!lock_path(path, sizeof path)) {
        return true;
    }
    /* One that another process removes meanwhile is another file. */
    while (attempts-- > 0) {
        lock_file = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        if (lock_file < 0) {
            return true;
        }
        const bool is_taken = flock(lock_file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
        if (is_taken) {
            close(lock_file);
            return false;
        }
        if (is_locked(path)) {
            atexit(unlock_retained);
            return true;
        }
        close(lock_file);
    }
    return true;
}
#else
/* This system has no locks. */
static bool lock_retained(void)
{
    return true;
}
#endif

/* Flushes a file to the disk; false with errno if that fails. */
static bool flush_file(FILE *file)
{
    return fsync(fileno(file)) == 0;
}

/* Flushes the folder of the file, so that its new name lasts; false with errno if that fails. */
static bool flush_folder(void)
{
    char folder[1024];
    const char *const slash = strrchr(retained.target, '/');
    const size_t length = slash != NULL ? (size_t)(slash - retained.target) + 1u : 0u;

    memcpy(folder, retained.target, length);
    folder[length] = '\0';
    const int file = open(length != 0u ? folder : ".", O_RDONLY);
    if (file < 0) {
        return false;
    }
    const bool done = fsync(file) == 0;
    const int error = errno;
    close(file);
    errno = error;
    return done;
}

/* Opens a file that does not exist yet; NULL with errno if it does. */
static FILE *open_new(const char *path)
{
    const int file = open(path, O_WRONLY | O_CREAT | O_EXCL, 0666);

    return file < 0 ? NULL : fdopen(file, "wb");
}

/* Opens a file to read it; NULL if it is none, but a link or a device. */
static FILE *open_rest(const char *path)
{
    struct stat found;
    const bool is_file = lstat(path, &found) == 0 && S_ISREG(found.st_mode);

    return is_file ? fopen(path, "rb") : NULL;
}

/* Gives a new file the name of the present one, which it replaces; false with errno if that fails. */
static bool take_name(const char *path)
{
    return rename(path, retained.target) == 0 && flush_folder();
}
#endif

/* Writes the record to a file, and flushes it; false with errno if the disk does not take it. */
static bool write_record(FILE *file)
{
    const bool done = fwrite(retained.record, 1, retained.length, file) == retained.length && fflush(file) == 0 && flush_file(file);
    const int error = errno;
    const bool closed = fclose(file) == 0;

    if (!done) {
        errno = error;
    }
    return done && closed;
}

/*
 * Removes what a save has left that power failure ended: the beginning of a record, or zeros in its place. Anything else of that
 * name is somebody's, and stays.
 */
static void remove_rest(const char *path)
{
    static const char zeros[4] = {0};
    char start[4];
    FILE *const file = open_rest(path);

    if (file == NULL) {
        return;
    }
    const size_t length = fread(start, 1, sizeof start, file);
    fclose(file);
    if (memcmp(start, "RGR1", length) == 0 || memcmp(start, zeros, length) == 0) {
        (void)remove(path);
    }
}

/*
 * Replaces the file: a new one beside it is written and flushed, and takes its name. Nothing remains of what a full disk does not
 * take. Returns why it cannot be; 0: it is.
 */
static int replace_file(void)
{
    char path[1024];
    const int length = snprintf(path, sizeof path, "%s.new", retained.target);

    if (length < 0 || (size_t)length >= sizeof path) {
        return ENAMETOOLONG;
    }
    remove_rest(path);
    FILE *const file = open_new(path);
    if (file == NULL) {
        return errno;
    }
    if (!write_record(file) || !take_name(path)) {
        const int error = errno;
        (void)remove(path);
        return error;
    }
    return 0;
}

/* The thread: writes one record after the other. */
static void *write_records(void *context)
{
    (void)context;
    for (;;) {
        if (sem_wait(&retained.to_write) == 0) {
            retained.error = replace_file();
            sem_post(&retained.written);
        }
    }
    return NULL;
}

/* Locks the file and starts the thread; false if another process uses the file, or if the system has no thread. */
static bool begin_retained(void)
{
    pthread_t thread;
    int error = 0;

    if (retained.path == NULL) {
        return true;
    }
    retained.target = behind_links(retained.path);
    if (!lock_retained()) {
        print(stderr, "PROGRAM: %s is in use by another process\n", retained.path);
        return false;
    }
    if (sem_init(&retained.to_write, 0, 0) != 0 || sem_init(&retained.written, 0, 0) != 0) {
        error = errno;
    } else {
        error = pthread_create(&thread, NULL, write_records, NULL);
    }
    if (error != 0) {
        print(stderr, "PROGRAM: no thread for %s: %s\n", retained.path, strerror(error));
    }
    return error == 0;
}

/* Saving fails: reports why, once. */
static void unsaved(const char *why)
{
    if (!retained.fails) {
        print(stderr, "PROGRAM: %s: %s; latched devices are not saved\n", retained.path, why);
    }
    retained.fails = true;
}

/* The record has been written, or this is why it cannot be. */
static void end_record(int error)
{
    retained.writes = false;
    if (error != 0) {
        unsaved(strerror(error));
        return;
    }
    retained.sequence++;
    retained.has_saved = true;
    retained.saved = retained.writing;
    if (retained.fails) {
        print(stderr, "PROGRAM: %s: latched devices are saved again\n", retained.path);
    }
    retained.fails = false;
}

/* Between scans: has what has changed saved, once a second. */
static void save_retained(PROGRAM_plc *plc, uint32_t now_ms)
{
    if (retained.path == NULL) {
        return;
    }
    if (retained.writes) {
        if (sem_trywait(&retained.written) == 0) {
            end_record(retained.error);
        } else if (now_ms - retained.looked_ms > SLOW_MS) {
            unsaved("the disk takes longer than 10 s");
        }
    } else if (now_ms - retained.looked_ms >= SAVE_EVERY_MS) {
        const uint32_t state = rungc_retained_state(&PROGRAM_retained, plc);
        retained.looked_ms = now_ms;
        if (!retained.has_saved || retained.saved != state) {
            record_retained(plc, state);
            retained.writes = true;
            sem_post(&retained.to_write);
        }
    }
    /* UNSAVED */
}

/* After the last scan: saves what has changed since, and waits for the disk; false if it does not take it. */
static bool end_retained(const PROGRAM_plc *plc)
{
    if (retained.path == NULL) {
        return true;
    }
    while (retained.writes) {
        if (sem_wait(&retained.written) == 0) {
            end_record(retained.error);
        }
    }
    const uint32_t state = rungc_retained_state(&PROGRAM_retained, plc);
    if (retained.has_saved && retained.saved == state) {
        return true;
    }
    record_retained(plc, state);
    const int error = replace_file();
    if (error != 0) {
        print(stderr, "PROGRAM: %s: %s; latched devices are not saved\n", retained.path, strerror(error));
    }
    return error == 0;
}

