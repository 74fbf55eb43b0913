/* The file that keeps latched devices from run to run; NULL: none does. */
static struct {
    const char *path;
    uint32_t sequence;
    uint32_t looked_ms;
    bool has_saved;
    uint32_t saved; /* checksum of the values that were loaded or saved last */
} kept;

static bool keep_in(const char *path)
{
    kept.path = path;
    return true;
}

static bool read_kept(void *context, uint32_t offset, void *bytes, uint32_t length)
{
    FILE *const file = context;

    return fseek(file, (long)offset, SEEK_SET) == 0 && fread(bytes, 1, length, file) == length;
}

/* Gives latched devices the values in the file, which need not exist; false if it cannot be used. */
static bool load_kept(PROGRAM_plc *plc)
{
    FILE *const file = kept.path != NULL ? fopen(kept.path, "rb") : NULL;
    const rungc_source source = {read_kept, file};
    rungc_record record = {0};
    rungc_loaded loaded = RUNGC_LOADED_FAILED;
    uint32_t dropped = 0;

    if (kept.path == NULL) {
        return true;
    }
    if (file == NULL && errno == ENOENT) {
        print(stderr, "PROGRAM: %s does not exist yet: latched devices begin as the PLC leaves the factory\n", kept.path);
        return true;
    }
    if (file == NULL) {
        print(stderr, "PROGRAM: %s: %s\n", kept.path, strerror(errno));
        return false;
    }
    const long end = fseek(file, 0, SEEK_END) == 0 ? ftell(file) : -1;
    if (end > 0 && rungc_find_record(&source, 0, (uint32_t)end, &record) && record.length != 0u) {
        loaded = rungc_restore(&PROGRAM_retained, plc, &source, &record, &dropped);
    }
    fclose(file);
    if (loaded == RUNGC_LOADED_FOREIGN) {
        print(stderr, "PROGRAM: %s holds the latched devices of `%s`, and this program is `%s`; name another file\n", kept.path, record.owner,
                PROGRAM_retained.program);
    } else if (loaded != RUNGC_LOADED_DEVICES) {
        print(stderr, "PROGRAM: %s does not hold latched devices, or is damaged\n", kept.path);
    } else if (dropped != 0u) {
        print(stderr, "PROGRAM: %s: %lu of its devices are dropped: the program does not use them as latched devices any more\n",
                kept.path, (unsigned long)dropped);
    }
    kept.sequence = record.sequence + 1u;
    kept.has_saved = dropped == 0u;
    kept.saved = rungc_retained_state(&PROGRAM_retained, plc);
    return loaded == RUNGC_LOADED_DEVICES;
}

static bool put_kept(void *context, const uint8_t *bytes, uint32_t length)
{
    return fwrite(bytes, 1, length, (FILE *)context) == length;
}

/* Flushes the folder of the file, so that its new name lasts. */
static bool flush_folder(void)
{
    char folder[1024];
    const char *const slash = strrchr(kept.path, '/');
    const size_t length = slash != NULL ? (size_t)(slash - kept.path) + 1u : 0u;

    if (length >= sizeof folder) {
        return false;
    }
    memcpy(folder, kept.path, length);
    folder[length] = '\0';
    const int file = open(length != 0u ? folder : ".", O_RDONLY);
    const bool done = file >= 0 && fsync(file) == 0;
    if (file >= 0) {
        close(file);
    }
    return done;
}

/* Replaces the file: a new one beside it is written and flushed, and takes its name. */
static bool replace_kept(const PROGRAM_plc *plc)
{
    char path[1024];
    const int length = snprintf(path, sizeof path, "%s.new", kept.path);
    FILE *const file = length > 0 && (size_t)length < sizeof path ? fopen(path, "wb") : NULL;
    const rungc_sink sink = {put_kept, file};

    if (file == NULL) {
        return false;
    }
    bool done = rungc_put_record(&PROGRAM_retained, plc, kept.sequence, &sink) && fflush(file) == 0 && fsync(fileno(file)) == 0;
    done = fclose(file) == 0 && done;
    return done && rename(path, kept.path) == 0 && flush_folder();
}

/* Saves what has changed, once a second or `now`. */
static void save_kept(const PROGRAM_plc *plc, uint32_t now_ms, bool now)
{
    if (kept.path == NULL || (!now && now_ms - kept.looked_ms < 1000u)) {
        return;
    }
    const uint32_t state = rungc_retained_state(&PROGRAM_retained, plc);
    kept.looked_ms = now_ms;
    if (kept.has_saved && kept.saved == state) {
        return;
    }
    if (!replace_kept(plc)) {
        print(stderr, "PROGRAM: %s: %s\n", kept.path, strerror(errno));
    } else {
        kept.sequence++;
        kept.has_saved = true;
        kept.saved = state;
    }
}

