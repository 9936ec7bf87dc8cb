//! The page of `reproduce` in a real browser: no errors of scripts, no line that is wider than the screen, tables that sort and a
//! slider that moves.

use super::document;
use crate::support::program::Program;
use crate::support::{browser, skip};
use serde_json::Value;
use std::path::Path;

/// Runs before all scripts of the page.
const BEFORE: &str = "<script>window.errors = []; window.addEventListener('error', (event) => window.errors.push(String(event.message)));
</script>";

/// What a page says of itself, when it is laid out, at the width of the window that it is in.
const AFTER: &str = r#"
const found = {};
const root = document.documentElement;
found.width = window.innerWidth;
found.overflow = root.scrollWidth - root.clientWidth;
found.ground = getComputedStyle(document.body).backgroundColor;
found.plots = [...document.querySelectorAll("svg")].map((svg) => [svg.querySelectorAll("circle.ours").length, svg.querySelectorAll("circle.published").length]);
const table = document.querySelector("table");
if (table) {
  const column = () => [...table.tBodies[0].rows].map((row) => row.cells[2].dataset.value ?? null);
  const head = table.tHead.rows[0].cells[2].querySelector("button");
  found.before = column();
  head.click();
  found.ascending = column();
  head.click();
  found.descending = column();
}
const slider = document.querySelector(".slider");
if (slider) {
  const [left, right] = [".left", ".right"].map((name) => slider.querySelector(name));
  const range = slider.querySelector("input");
  const clip = () => getComputedStyle(left).clipPath;
  found.clips = [clip()];
  range.value = 20;
  range.dispatchEvent(new Event("input"));
  found.clips.push(clip());
  found.sizes = [left, right].map((image) => [image.naturalWidth, image.getBoundingClientRect().width]);
  const choice = slider.querySelector("select");
  const before = left.src;
  choice.value = "1";
  choice.dispatchEvent(new Event("change"));
  found.chosen = [left.src === right.src, left.src !== before];
}
found.errors = window.errors;
"#;

/// What the page of a file says in a frame of this width.
pub fn shown(program: &Program, page: &str, browser: &Path, width: u32) -> Value {
    let html = std::fs::read_to_string(program.path(page)).unwrap();
    assert!(
        !html.contains("http://") && !html.contains("src=\"//") && !html.contains("https://"),
        "it wants the network"
    );
    let html = html.replacen("<head>", &format!("<head>{BEFORE}"), 1);
    let after = format!(
        "<script>window.addEventListener('load', () => {{ {AFTER} parent.document.getElementById('found').textContent = JSON.stringify(found); }});</script></body>"
    );
    let html = html.replacen("</body>", &after, 1);
    let quoted = html.replace('&', "&amp;").replace('"', "&quot;");
    let outer = format!(
        "<!DOCTYPE html><body><pre id=\"found\"></pre><iframe style=\"width:{width}px;height:800px;border:0\" srcdoc=\"{quoted}\"></iframe></body>"
    );
    let file = program.path(&format!("page-{width}.html"));
    std::fs::write(&file, outer).unwrap();
    let output = std::process::Command::new(browser)
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--virtual-time-budget=10000"])
        .arg(format!("--user-data-dir={}", program.path("profile")))
        .args(["--window-size=1400,900", "--dump-dom"])
        .arg(format!("file://{file}"))
        .env("HOME", program.folder.path())
        .output()
        .unwrap();
    let dom = String::from_utf8_lossy(&output.stdout).into_owned();
    let text = dom.split("<pre id=\"found\">").nth(1).and_then(|rest| rest.split("</pre>").next());
    let text = text.unwrap_or_else(|| panic!("no page: {}", String::from_utf8_lossy(&output.stderr)));
    let text = text.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&");
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}: {text:?}"))
}

#[test]
fn the_page_is_laid_out_sorts_and_slides_without_errors() {
    let Some(browser) = browser() else { return skip("there is no chromium") };
    let program = Program::new();
    let small = ["--scene", "cornell", "--size", "32x32", "--vpls", "32", "--quick", "--quiet", "-o", "out"];
    program.run(&[&["reproduce", "segovia-2006/figure-6"], &small[..]].concat()).fine();
    let made = document(&program, "out/segovia-2006/figure-6/cornell/result.json");
    let errors: Vec<f64> = made["tables"][0]["cells"]
        .as_array()
        .unwrap()
        .iter()
        .map(|cell| cell["ours"]["value"].as_f64().unwrap())
        .collect();
    for width in [390, 1280] {
        let found = shown(&program, "out/index.html", &browser, width);
        assert_eq!(found["errors"], serde_json::json!([]), "{found:#}");
        assert_eq!((&found["width"], &found["overflow"]), (&Value::from(width), &Value::from(0)), "{found:#}");
        let numbers = |key: &str| -> Vec<f64> {
            found[key].as_array().unwrap().iter().map(|value| value.as_str().unwrap().parse().unwrap()).collect()
        };
        let mut sorted = errors.clone();
        assert_eq!(numbers("before"), errors);
        sorted.sort_by(f64::total_cmp);
        assert_eq!(numbers("ascending"), sorted);
        sorted.reverse();
        assert_eq!(numbers("descending"), sorted);
        let clips = found["clips"].as_array().unwrap();
        assert!(clips[0].as_str().unwrap().contains("50%") && clips[1].as_str().unwrap().contains("80%"), "{clips:?}");
        let sizes = found["sizes"].as_array().unwrap();
        assert!(sizes.iter().all(|size| size[0] == 32), "pictures are in the page: {sizes:?}");
        assert_eq!(sizes[0][1], sizes[1][1], "one lies over the other");
        assert_eq!(found["chosen"], serde_json::json!([true, true]));
        // Errors of other kinds are in plots of their own: three ways in each of three.
        assert_eq!(found["plots"], serde_json::json!([[3, 0], [3, 0], [3, 0]]));
    }
}
