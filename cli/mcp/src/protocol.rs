//! Messages: JSON-RPC 2.0, and the versions of the protocol.

use serde_json::{Map, Value, json};

/// Versions with a handshake, newest first.
pub(crate) const HANDSHAKE: [&str; 4] = ["2025-11-25", "2025-06-18", "2025-03-26", "2024-11-05"];

/// Version in which each request names it.
pub(crate) const STATELESS: &str = "2026-07-28";

/// The only version in which several messages may be one array.
pub(crate) const WITH_BATCHES: &str = "2025-03-26";

/// Key of the version in a request.
pub(crate) const VERSION_KEY: &str = "io.modelcontextprotocol/protocolVersion";

/// Key of the server in a result.
const SERVER_KEY: &str = "io.modelcontextprotocol/serverInfo";

/// An error of the protocol.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Fault {
    code: i32,
    message: String,
    data: Option<Value>,
}

impl Fault {
    fn new(code: i32, message: impl Into<String>) -> Self {
        Fault {
            code,
            message: message.into(),
            data: None,
        }
    }

    /// The line is not JSON.
    pub(crate) fn not_json(why: &serde_json::Error) -> Self {
        Fault::new(-32700, format!("this line is not JSON: {why}"))
    }

    /// The line is not a message.
    pub(crate) fn not_a_message(why: impl Into<String>) -> Self {
        Fault::new(-32600, why)
    }

    /// No such method.
    pub(crate) fn unknown_method(method: &str) -> Self {
        Fault::new(-32601, format!("there is no method `{}`", clipped(method)))
    }

    /// Parameters that do not fit the method.
    pub(crate) fn wrong_params(why: impl Into<String>) -> Self {
        Fault::new(-32602, why)
    }

    /// A mistake in this server.
    pub(crate) fn own() -> Self {
        let why =
            "this request made rungc fail; it can answer others; please report what you asked for";
        Fault::new(-32603, why)
    }

    /// Too many requests wait.
    pub(crate) fn busy(waiting: usize) -> Self {
        Fault::new(
            -32000,
            format!("{waiting} requests are waiting; send this one again later"),
        )
    }

    /// No resource has this address.
    pub(crate) fn no_resource(uri: &str, why: &str, version: &str) -> Self {
        let code = match version {
            STATELESS => -32602,
            _ => -32002,
        };
        Fault {
            data: Some(json!({ "uri": clipped(uri) })),
            ..Fault::new(code, why)
        }
    }

    /// A version that a request names and that is not spoken.
    pub(crate) fn unknown_version(requested: &str) -> Self {
        let mut supported = vec![STATELESS];
        supported.extend(HANDSHAKE);
        Fault {
            data: Some(json!({ "supported": supported, "requested": clipped(requested) })),
            ..Fault::new(
                -32022,
                format!("version `{}` is not supported", clipped(requested)),
            )
        }
    }
}

/// The beginning of a text that a client has sent, for messages.
pub(crate) fn clipped(text: &str) -> String {
    const LENGTH: usize = 80;
    match text.char_indices().nth(LENGTH) {
        None => text.to_owned(),
        Some((end, _)) => format!("{}…", &text[..end]),
    }
}

/// A message from the client.
#[derive(Debug)]
pub(crate) enum Message {
    /// Wants an answer.
    Request(Request),
    /// Wants none.
    Notification {
        /// Its method.
        method: String,
        /// Its parameters.
        params: Map<String, Value>,
    },
    /// An answer, though nothing was asked.
    Answer,
}

/// A request.
#[derive(Debug)]
pub(crate) struct Request {
    /// A text or an integer, which the answer repeats.
    pub(crate) id: Value,
    /// Its method.
    pub(crate) method: String,
    /// Its parameters.
    pub(crate) params: Map<String, Value>,
}

impl Request {
    /// The version that it names itself.
    pub(crate) fn version(&self) -> Option<&str> {
        self.params.get("_meta")?.get(VERSION_KEY)?.as_str()
    }
}

/// Reads a message; else the identifier to answer, and why it is none.
pub(crate) fn message(value: Value) -> Result<Message, (Value, Fault)> {
    let Value::Object(mut message) = value else {
        let why = "a message is a JSON object with \"jsonrpc\": \"2.0\"";
        return Err((Value::Null, Fault::not_a_message(why)));
    };
    let id = message.remove("id");
    let is_id = |id: &Value| id.is_string() || id.is_i64() || id.is_u64();
    let known = id.clone().filter(is_id).unwrap_or(Value::Null);
    let wrong = |why: &str| Err((known.clone(), Fault::not_a_message(why)));
    if message.get("jsonrpc") != Some(&json!("2.0")) {
        return wrong("a message has \"jsonrpc\": \"2.0\"");
    }
    if !message.contains_key("method")
        && (message.contains_key("result") || message.contains_key("error"))
    {
        return Ok(Message::Answer);
    }
    let Some(Value::String(method)) = message.remove("method") else {
        return wrong("a request has a \"method\", which is a text");
    };
    if id.as_ref().is_some_and(|id| !is_id(id)) {
        return wrong("an \"id\" is a text or an integer");
    }
    let params = match message.remove("params") {
        None | Some(Value::Null) => Map::new(),
        Some(Value::Object(params)) => params,
        Some(_) => {
            let why = Fault::wrong_params("\"params\" is an object");
            return Err((known, why));
        }
    };
    Ok(match id {
        Some(id) => Message::Request(Request { id, method, params }),
        None => Message::Notification { method, params },
    })
}

/// The answer to a request.
pub(crate) fn answer(id: &Value, result: Result<Value, Fault>) -> Value {
    match result {
        Ok(result) => json!({ "jsonrpc": "2.0", "id": id, "result": result }),
        Err(Fault {
            code,
            message,
            data,
        }) => {
            let mut error = json!({ "code": code, "message": message });
            if let Some(data) = data {
                error["data"] = data;
            }
            json!({ "jsonrpc": "2.0", "id": id, "error": error })
        }
    }
}

/// Name and version of this server.
pub(crate) fn server_info() -> Value {
    json!({ "name": "rungc", "title": "rungc: programs of FX-family PLCs", "version": env!("CARGO_PKG_VERSION") })
}

/// Adds what the version without a handshake demands of every result, and of those that may be kept for a while.
pub(crate) fn complete(result: &mut Value, method: &str) {
    /// Nothing but files changes while a server runs, and lists do not depend on files.
    const LASTS_MS: u64 = 3_600_000;
    result["resultType"] = json!("complete");
    result["_meta"][SERVER_KEY] = server_info();
    let lists = ["server/discover", "resources/read"];
    if lists.contains(&method) || method.ends_with("/list") {
        result["ttlMs"] = json!(LASTS_MS);
        result["cacheScope"] = json!("private");
    }
}

#[cfg(test)]
mod tests {
    use super::{Message, clipped, message};
    use serde_json::{Value, json};

    #[test]
    fn what_is_not_a_message_is_answered_with_its_identifier() {
        let id = |value: Value| message(value).err().map(|(id, _)| id);
        for wrong in [
            json!(7),
            json!([]),
            json!("a"),
            Value::Null,
            json!({}),
            json!({ "jsonrpc": "1.0" }),
        ] {
            assert_eq!(id(wrong.clone()), Some(Value::Null), "{wrong}");
        }
        let request = |id: Value| json!({ "jsonrpc": "2.0", "id": id, "method": "ping" });
        assert_eq!(id(request(json!(null))), Some(Value::Null));
        assert_eq!(id(request(json!(1.5))), Some(Value::Null));
        assert_eq!(
            id(json!({ "jsonrpc": "2.0", "id": "a", "method": 5 })),
            Some(json!("a"))
        );
        assert_eq!(
            id(json!({ "jsonrpc": "2.0", "id": 2, "method": "ping", "params": [1] })),
            Some(json!(2))
        );
        assert!(matches!(
            message(request(json!(-3))),
            Ok(Message::Request(_))
        ));
        let answer = json!({ "jsonrpc": "2.0", "id": 1, "result": {} });
        assert!(matches!(message(answer), Ok(Message::Answer)));
    }

    #[test]
    fn long_texts_are_clipped_between_characters() {
        assert_eq!(clipped("abc"), "abc");
        assert_eq!(clipped(&"启".repeat(100)).chars().count(), 81);
    }
}
