//! A picture in ten lines: `cargo run --release --example picture`.

use quincunx::job::Job;

fn main() -> Result<(), quincunx::Error> {
    let technique = quincunx::techniques::find("interleaved_deferred")?;
    let mut job = Job::new("cornell", technique);
    job.set("size", "640x360")?;
    job.set("pattern", "4x4")?;
    job.output = Some("cornell.exr".into());
    let outcome = job.run()?;
    println!("{}", outcome.report.text());
    Ok(())
}
