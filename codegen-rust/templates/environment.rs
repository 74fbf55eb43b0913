
/// Connections and the log.
fn environment() -> MutexGuard<'static, Environment> {
    static ENVIRONMENT: LazyLock<Mutex<Environment>> = LazyLock::new(Mutex::default);
    ENVIRONMENT.lock().unwrap_or_else(PoisonError::into_inner)
}
