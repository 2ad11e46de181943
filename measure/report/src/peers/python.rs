//! Methods with a Python interface: `python/peers.py` runs them and times them itself, in this program's
//! turns.

use std::cell::RefCell;
use std::env;
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

use anyhow::{Context, Result, bail, ensure};

/// What the script has, and what it said of what it has not.
pub struct Python {
    process: RefCell<Process>,
    pub methods: Vec<&'static str>,
    /// Those that find crossings.
    pub events: Vec<&'static str>,
    /// Those for mechanisms on constraints: without their multipliers to a tolerance, and by step sizes.
    pub reduced: Vec<&'static str>,
    pub stepped: Vec<&'static str>,
    pub missing: Vec<String>,
    pub versions: Vec<String>,
}

struct Process {
    child: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
}

impl Python {
    /// Starts the script with the interpreter that the variable `PYTHON` names, or else `python3`.
    ///
    /// # Errors
    /// There is no such interpreter, or the script fails.
    pub fn start() -> Result<Self> {
        let interpreter = env::var("PYTHON").unwrap_or_else(|_| "python3".into());
        let mut child = Command::new(&interpreter)
            .arg(concat!(env!("CARGO_MANIFEST_DIR"), "/python/peers.py"))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .with_context(|| format!("cannot run {interpreter}; name a Python interpreter in PYTHON"))?;
        let input = child.stdin.take().context("no standard input")?;
        let output = BufReader::new(child.stdout.take().context("no standard output")?);
        let mut process = Process { child, input, output };
        let (mut methods, mut events) = (Vec::new(), Vec::new());
        let (mut reduced, mut stepped) = (Vec::new(), Vec::new());
        let (mut missing, mut versions) = (Vec::new(), Vec::new());
        loop {
            let line = process.line()?;
            match line.split_once(' ').unwrap_or((&line, "")) {
                ("method", name) => methods.push(&*name.to_owned().leak()),
                ("events", name) => events.push(&*name.to_owned().leak()),
                ("reduced", name) => reduced.push(&*name.to_owned().leak()),
                ("stepped", name) => stepped.push(&*name.to_owned().leak()),
                ("missing", what) => missing.push(what.to_owned()),
                ("version", what) => versions.push(what.to_owned()),
                ("ready", "") => break,
                _ => bail!("peers.py said {line:?}"),
            }
        }
        Ok(Self { process: RefCell::new(process), methods, events, reduced, stepped, missing, versions })
    }

    /// Seconds of one trajectory of the scene of that name, and (q, v) at the ends of so many equal
    /// intervals; of a batch of all its trajectories, the scene's own first.
    ///
    /// # Errors
    /// What the script says.
    pub fn run<const M: usize>(
        &self,
        method: &str,
        scene: &str,
        tolerance: f64,
        repeats: u32,
        samples: usize,
    ) -> Result<(f64, Vec<[f64; M]>)> {
        let mut process = self.process.borrow_mut();
        writeln!(process.input, "{method}\t{scene}\t{tolerance:e}\t{repeats}\t{samples}")?;
        process.input.flush()?;
        let line = process.line()?;
        let Some(numbers) = line.strip_prefix("end ") else { bail!("{line}") };
        let mut numbers = numbers.split(' ').map(str::parse::<f64>);
        let seconds = numbers.next().context("no time")??;
        let numbers: Vec<f64> = numbers.collect::<Result<_, _>>()?;
        let (states, rest) = numbers.as_chunks();
        let is_whole = rest.is_empty() && !states.is_empty() && states.len().is_multiple_of(samples);
        ensure!(is_whole, "{} numbers for {samples} states", numbers.len());
        Ok((seconds, states.to_vec()))
    }
}

impl Process {
    fn line(&mut self) -> Result<String> {
        let mut line = String::new();
        if self.output.read_line(&mut line)? == 0 {
            bail!("peers.py ended: {}", self.child.wait()?);
        }
        Ok(line.trim_end().to_owned())
    }
}
