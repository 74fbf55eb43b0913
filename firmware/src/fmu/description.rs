//! `modelDescription.xml` and `buildDescription.xml`.

use super::{Causality, Fmu, SCAN_MS, SCAN_NAME, TIME_NAME, Variable};
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};
use rungc_emit::OutFile;
use std::io;

type Xml = Writer<Vec<u8>>;

/// Attributes of an element.
type Attributes<'a> = &'a [(&'a str, &'a str)];

/// A document with this root.
fn document(
    root: &str,
    attributes: Attributes,
    inside: impl FnOnce(&mut Xml) -> io::Result<()>,
) -> io::Result<Vec<u8>> {
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 2);
    xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    node(&mut xml, root, attributes, inside)?;
    let mut text = xml.into_inner();
    text.push(b'\n');
    Ok(text)
}

/// An element with others in it.
fn node(
    xml: &mut Xml,
    name: &str,
    attributes: Attributes,
    inside: impl FnOnce(&mut Xml) -> io::Result<()>,
) -> io::Result<()> {
    let element = xml.create_element(name);
    let element = element.with_attributes(attributes.iter().copied());
    element.write_inner_content(inside).map(|_| ())
}

/// An element without content.
fn leaf(xml: &mut Xml, name: &str, attributes: Attributes) -> io::Result<()> {
    let element = xml.create_element(name);
    let element = element.with_attributes(attributes.iter().copied());
    element.write_empty().map(|_| ())
}

/// A text without the characters that XML 1.0 cannot represent.
fn clean(text: &str) -> String {
    let is_odd = |c: &char| c.is_control() || matches!(c, '\u{FFFE}' | '\u{FFFF}');
    text.chars().filter(|c| !is_odd(c)).collect()
}

/// `modelDescription.xml`.
pub(super) fn model(fmu: &Fmu) -> io::Result<String> {
    let module = fmu.module;
    let tool = format!("rungc {}", env!("CARGO_PKG_VERSION"));
    let description = format!(
        "The PLC program {} for {}",
        module.source_name, module.model.title
    );
    let attributes = [
        ("fmiVersion", "3.0"),
        ("generationTool", &tool),
        ("modelName", &clean(&module.full_name)),
        ("instantiationToken", &fmu.token),
        ("description", &clean(&description)),
        ("variableNamingConvention", "flat"),
    ];
    let text = document("fmiModelDescription", &attributes, |xml| {
        leaf(
            xml,
            "CoSimulation",
            &[
                ("modelIdentifier", fmu.identifier()),
                ("canHandleVariableCommunicationStepSize", "true"),
                ("canBeInstantiatedOnlyOncePerProcess", "false"),
                ("canGetAndSetFMUState", "true"),
                ("canSerializeFMUState", "true"),
            ],
        )?;
        node(xml, "LogCategories", &[], |xml| {
            let error = (
                "description",
                "Calls that cannot be answered; always logged",
            );
            leaf(xml, "Category", &[("name", "logStatusError"), error])?;
            let events = (
                "description",
                "Operation errors of the program, and its STOP",
            );
            leaf(xml, "Category", &[("name", "logEvents"), events])
        })?;
        let step = format!("{}", f64::from(SCAN_MS) / 1000.0);
        let experiment = [("startTime", "0"), ("stepSize", step.as_str())];
        leaf(xml, "DefaultExperiment", &experiment)?;
        node(xml, "ModelVariables", &[], |xml| variables(xml, fmu))?;
        node(xml, "ModelStructure", &[], |xml| structure(xml, fmu))
    })?;
    String::from_utf8(text).map_err(io::Error::other)
}

fn variables(xml: &mut Xml, fmu: &Fmu) -> io::Result<()> {
    let time = [
        ("name", TIME_NAME),
        ("valueReference", "0"),
        ("description", "Simulation time in seconds"),
        ("causality", "independent"),
        ("variability", "continuous"),
    ];
    leaf(xml, "Float64", &time)?;
    let start = SCAN_MS.to_string();
    let scan = [
        ("name", SCAN_NAME),
        ("valueReference", "1"),
        ("description", "Duration of a scan in milliseconds"),
        ("causality", "parameter"),
        ("variability", "fixed"),
        ("start", start.as_str()),
        ("min", "1"),
        ("max", "32767"),
    ];
    leaf(xml, "Int32", &scan)?;
    fmu.variables()
        .iter()
        .try_for_each(|one| variable(xml, one))
}

fn variable(xml: &mut Xml, variable: &Variable) -> io::Result<()> {
    let reference = variable.reference().to_string();
    let device = variable.device.to_string();
    let description = match clean(&variable.description) {
        text if text.is_empty() || text == device => device,
        text => format!("{device}: {text}"),
    };
    let mut attributes = vec![
        ("name", variable.name.as_str()),
        ("valueReference", &reference),
        ("description", &description),
        ("causality", variable.causality.name()),
        ("variability", "discrete"),
    ];
    match variable.causality {
        Causality::Input => attributes.push(("start", variable.ty().zero())),
        Causality::Output | Causality::Local => attributes.push(("initial", "calculated")),
    }
    leaf(xml, variable.ty().name(), &attributes)
}

/// The outputs, which depend on anything.
fn structure(xml: &mut Xml, fmu: &Fmu) -> io::Result<()> {
    for element in ["Output", "InitialUnknown"] {
        let outputs = fmu.variables().iter();
        let outputs = outputs.filter(|variable| variable.causality == Causality::Output);
        for output in outputs {
            let reference = output.reference().to_string();
            leaf(xml, element, &[("valueReference", &reference)])?;
        }
    }
    Ok(())
}

/// `buildDescription.xml`.
pub(super) fn build(fmu: &Fmu) -> io::Result<String> {
    let text = document("fmiBuildDescription", &[("fmiVersion", "3.0")], |xml| {
        let identifier = [("modelIdentifier", fmu.identifier())];
        node(xml, "BuildConfiguration", &identifier, |xml| {
            node(xml, "SourceFileSet", &[("language", "C99")], |xml| {
                let is_source = |file: &&OutFile| file.path.ends_with(".c");
                let sources = fmu.sources().iter().filter(is_source);
                for file in sources {
                    leaf(xml, "SourceFile", &[("name", &file.path)])?;
                }
                Ok(())
            })
        })
    })?;
    String::from_utf8(text).map_err(io::Error::other)
}
