//! Brokers by TLS, with rustls: certificates in files of PEM, and what to do where one does not fit.

use rumqttc::{ConnectionError, StateError, TlsConfiguration, TlsError, Transport, mqttbytes};
use rungc_host::io::Connection;
use rustls::crypto::ring;
use rustls::pki_types::pem::PemObject;
use rustls::pki_types::{CertificateDer, PrivateKeyDer};
use rustls::{AlertDescription, CertificateError, ClientConfig, Error, RootCertStore};
use std::io::ErrorKind;
use std::sync::Arc;

/// Encryption of a connection, if it is requested.
///
/// # Errors
///
/// A file cannot be read, or does not have the contents that its key names.
pub(crate) fn transport(connection: &Connection) -> Result<Option<Transport>, String> {
    let option = |key: &str| connection.options.get(key);
    let Some(ca) = option("ca") else {
        return Ok(None);
    };
    let mut roots = RootCertStore::empty();
    if let (0, _) = roots.add_parsable_certificates(certificates(ca)?) {
        return Err(format!("{ca}: no certificate of an authority"));
    }
    let config = ClientConfig::builder_with_provider(Arc::new(ring::default_provider()))
        .with_safe_default_protocol_versions()
        .map_err(|error| error.to_string())?
        .with_root_certificates(roots);
    let config = match option("certificate").zip(option("key")) {
        Some((certificate, key)) => {
            let wrong = |error| match error {
                Error::InconsistentKeys(_) => format!("{key} is not the key of {certificate}"),
                _ => format!("{certificate}, {key}: {error}"),
            };
            let chain = certificates(certificate)?;
            let own = config.with_client_auth_cert(chain, private_key(key)?);
            own.map_err(wrong)?
        }
        None => config.with_no_client_auth(),
    };
    let config = TlsConfiguration::Rustls(Arc::new(config));
    Ok(Some(Transport::tls_with_config(config)))
}

fn read(path: &str) -> Result<Vec<u8>, String> {
    std::fs::read(path).map_err(|error| format!("{path}: {error}"))
}

fn certificates(path: &str) -> Result<Vec<CertificateDer<'static>>, String> {
    let found = CertificateDer::pem_slice_iter(&read(path)?).collect::<Result<Vec<_>, _>>();
    match found {
        Ok(found) if !found.is_empty() => Ok(found),
        Ok(_) => Err(format!("{path}: no certificate in PEM")),
        Err(error) => Err(format!("{path}: {error}")),
    }
}

fn private_key(path: &str) -> Result<PrivateKeyDer<'static>, String> {
    let none = |_| format!("{path}: no private key in PEM, or one with a password");
    PrivateKeyDer::from_pem_slice(&read(path)?).map_err(none)
}

/// Reason why there is no connection, and a remedy. `accepted`: whether the broker had accepted it before.
pub fn explained(error: &ConnectionError, connection: &Connection, accepted: bool) -> String {
    let option = |key: &str| connection.options.get(key).map(String::as_str);
    let (Some(ca), false) = (option("ca"), accepted) else {
        return error.to_string();
    };
    let in_handshake = matches!(error, ConnectionError::Tls(_));
    match of_tls(error) {
        Some(Error::InvalidCertificate(why)) => unfit(why, ca),
        Some(Error::AlertReceived(alert)) => rejected(*alert, option("certificate")),
        Some(Error::InvalidMessage(_)) => NO_TLS.to_string(),
        Some(other) => format!("TLS: {other}"),
        None if in_handshake && is_closed(error) => NO_TLS.to_string(),
        // A broker may close before its reason has been read.
        None if is_closed(error) && option("certificate").is_none() => {
            format!("{error}: {ASKED_FOR}, if the broker asks for one")
        }
        None => error.to_string(),
    }
}

/// Message for a port that does not speak TLS.
const NO_TLS: &str =
    "the broker does not answer by TLS: name its port for it, usually 8883, or leave out `ca`";

/// Advice on certificates.
const ASKED_FOR: &str = "name a certificate of the PLC with `certificate` and `key`";

/// The part of an error that is TLS's.
fn of_tls(error: &ConnectionError) -> Option<&Error> {
    match error {
        ConnectionError::Tls(TlsError::TLS(error)) => Some(error),
        _ => of_io(error)?.get_ref()?.downcast_ref(),
    }
}

/// The part of an error that is the network's, before and after the handshake.
fn of_io(error: &ConnectionError) -> Option<&std::io::Error> {
    match error {
        ConnectionError::Tls(TlsError::Io(error))
        | ConnectionError::Io(error)
        | ConnectionError::MqttState(
            StateError::Io(error) | StateError::Deserialization(mqttbytes::Error::Io(error)),
        ) => Some(error),
        _ => None,
    }
}

/// Returns true if the broker has closed the connection without a reason.
fn is_closed(error: &ConnectionError) -> bool {
    let closed = |error: &std::io::Error| {
        matches!(
            error.kind(),
            ErrorKind::UnexpectedEof
                | ErrorKind::ConnectionReset
                | ErrorKind::ConnectionAborted
                | ErrorKind::BrokenPipe
        )
    };
    let aborted = matches!(
        error,
        ConnectionError::MqttState(StateError::ConnectionAborted)
    );
    of_io(error).map_or(aborted, closed)
}

/// The broker's certificate does not fit.
fn unfit(why: &CertificateError, ca: &str) -> String {
    let what = match why {
        CertificateError::UnknownIssuer | CertificateError::BadSignature => {
            format!("is not from an authority in {ca}: put the one that issued it there")
        }
        CertificateError::Expired | CertificateError::ExpiredContext { .. } => {
            "has expired: renew it, or set the clock of this machine".to_string()
        }
        CertificateError::NotValidYet | CertificateError::NotValidYetContext { .. } => {
            "is not valid yet: set the clock of this machine".to_string()
        }
        CertificateError::NotValidForNameContext {
            expected,
            presented,
        } => {
            let names: Vec<_> = presented.iter().map(|name| bare(name)).collect();
            let names = match names.as_slice() {
                [] => "no name".to_string(),
                names => names.join(", "),
            };
            format!(
                "is for {names}: name the broker as it does, or issue one for `{}` (subjectAltName)",
                expected.to_str()
            )
        }
        CertificateError::Other(other) => match other.0.to_string().as_str() {
            "UnsupportedCertVersion" => {
                "is of version 1: issue it anew with its name as an extension (subjectAltName)"
                    .to_string()
            }
            "CaUsedAsEndEntity" => {
                "is that of an authority: issue one for the broker by it".to_string()
            }
            other => format!("cannot be used: {other}"),
        },
        other => format!("cannot be used: {other}"),
    };
    format!("the broker's certificate {what}")
}

/// A name without the kind that rustls puts before it: `DnsName("broker.example")`.
fn bare(name: &str) -> &str {
    name.split('"').nth(1).unwrap_or(name)
}

/// The broker does not accept the certificate of the PLC, or misses one.
fn rejected(alert: AlertDescription, certificate: Option<&str>) -> String {
    use AlertDescription as Alert;
    match (alert, certificate) {
        (Alert::CertificateRequired | Alert::HandshakeFailure, None) => {
            format!("the broker asks for a certificate: {ASKED_FOR}")
        }
        (
            Alert::BadCertificate
            | Alert::UnsupportedCertificate
            | Alert::CertificateRevoked
            | Alert::CertificateExpired
            | Alert::CertificateUnknown
            | Alert::UnknownCA
            | Alert::AccessDenied
            | Alert::DecryptError,
            Some(path),
        ) => format!(
            "the broker rejects {path} ({alert:?}): it takes one that is valid, of an authority that it knows"
        ),
        _ => format!("TLS: the broker ends the connection ({alert:?})"),
    }
}
