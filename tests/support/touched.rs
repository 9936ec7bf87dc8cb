//! What a render counts of the bytes that its passes touch.

use super::benched::read;
use super::program::Program;
use serde_json::Value;

/// Report of a render.
pub fn rendered(program: &Program, arguments: &[&str]) -> Value {
    rendered_with(program, arguments, &[])
}

/// The same, with variables of the environment.
pub fn rendered_with(program: &Program, arguments: &[&str], variables: &[(&str, &str)]) -> Value {
    let files = ["-o", "picture.png", "--report", "report.json", "--quiet"];
    program.run_with(&[&["render"], arguments, &files].concat(), variables).fine();
    serde_json::from_str(&read(program, "report.json")).unwrap()
}

/// Entries of a list.
pub fn list(value: &Value) -> &[Value] {
    value.as_array().unwrap_or_else(|| panic!("no list: {value}"))
}

/// The row whose `key` ends so.
pub fn ends<'a>(rows: &'a [Value], key: &str, end: &str) -> &'a Value {
    let found = rows.iter().find(|row| row[key].as_str().unwrap().ends_with(end));
    found.unwrap_or_else(|| panic!("no {end} in {rows:#?}"))
}

/// A pass's row of a resource, both named by the ends of their names.
pub fn row<'a>(report: &'a Value, pass: &str, resource: &str) -> &'a Value {
    let pass = ends(list(&report["memory"]["touched"]["passes"]), "pass", pass);
    ends(list(&pass["resources"]), "resource", resource)
}

/// Bytes that are read, written, asked for by reads, and by writes.
pub fn bytes(row: &Value) -> [u64; 4] {
    ["read_bytes", "written_bytes", "asked_read_bytes", "asked_written_bytes"].map(|key| row[key].as_u64().unwrap())
}
