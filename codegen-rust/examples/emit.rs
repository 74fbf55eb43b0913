#![allow(missing_docs)]
use rungc_ir::compile::{CompileOptions, compile};
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let mut modules = vec![];
    for path in &args[3..] {
        let read = rungc_frontend::read(std::path::Path::new(path)).unwrap();
        let mut options = CompileOptions::default();
        options.optimise = true;
        if let Some(m) = path
            .rsplit('_')
            .next()
            .and_then(|m| rungc_ir::ModelId::from_name(m.trim_end_matches(".il")))
        {
            options.model = Some(m);
        }
        let t = std::time::Instant::now();
        let c = compile(&read.program, &options);
        if args.len() < 10 {
            eprintln!("{path}: compile {:?}", t.elapsed());
        }
        if std::env::var("VERBOSE").is_ok() {
            for d in c.diagnostics.iter().take(5) {
                eprintln!("{d:?}");
            }
        }
        if let Some(m) = c.module {
            modules.push(m);
        }
    }
    let out = std::path::Path::new(&args[2]);
    let t = std::time::Instant::now();
    let files = if args[1] == "batch" {
        rungc_codegen_rust::batch(&modules)
    } else {
        rungc_codegen_rust::emit(
            &modules[0],
            &rungc_codegen_rust::Options {
                main: true,
                ..Default::default()
            },
        )
    };
    eprintln!("emit {:?}", t.elapsed());
    for f in files {
        let p = out.join(f.path);
        std::fs::create_dir_all(p.parent().unwrap()).unwrap();
        std::fs::write(p, f.text).unwrap();
    }
}
