
/// Connections and the log.
fn outside() -> MutexGuard<'static, Outside> {
    static OUTSIDE: LazyLock<Mutex<Outside>> = LazyLock::new(Mutex::default);
    OUTSIDE.lock().unwrap_or_else(PoisonError::into_inner)
}
