//! Tests of what goes with the executable.

use clap::ValueEnum;

use super::*;

/// Every verb that has none below it, by its full name, such as `record info`.
fn verbs() -> Vec<(String, clap::Command)> {
    fn below(command: &clap::Command, name: &str, found: &mut Vec<(String, clap::Command)>) {
        for verb in visible(command) {
            let name = format!("{name} {}", verb.get_name());
            match visible(verb).next() {
                Some(_) => below(verb, &name, found),
                None => found.push((name, verb.clone())),
            }
        }
    }
    let mut found = Vec::new();
    below(&built(), "shoal", &mut found);
    found
}

#[test]
fn the_help_of_every_verb_has_an_example_of_it() {
    let verbs = verbs();
    assert!(verbs.len() > 12, "{}", verbs.len());
    for (name, verb) in verbs {
        let help = verb.clone().render_long_help().to_string();
        let examples = verb.get_after_help().map(ToString::to_string).unwrap_or_default();
        assert!(examples.contains(&name), "`{name} --help` shows no example of it:\n{help}");
        assert!(verb.get_about().is_some(), "`{name}` does not say what it does");
    }
}

/// The words of a line as a shell splits it: what is in quotes is one.
fn words(line: &str) -> Vec<String> {
    let (mut words, mut quote) = (vec![String::new()], None);
    for letter in line.chars() {
        match letter {
            '"' | '\'' if quote.is_none() => quote = Some(letter),
            _ if quote == Some(letter) => quote = None,
            ' ' if quote.is_none() => words.push(String::new()),
            _ => words.last_mut().unwrap().push(letter),
        }
    }
    words.retain(|word| !word.is_empty());
    words
}

#[test]
fn the_examples_of_every_verb_are_understood() {
    use clap::Parser;
    for (name, verb) in verbs() {
        let examples = verb.get_after_help().map(ToString::to_string).unwrap_or_default();
        let lines = examples.lines().map(str::trim).filter(|line| line.starts_with("shoal "));
        for line in lines {
            // What a shell does with the output is not ours.
            let words: Vec<String> = words(line)
                .into_iter()
                .take_while(|word| !["|", ">", "#"].contains(&word.as_str()) && !word.starts_with('('))
                .collect();
            if let Err(error) = Cli::try_parse_from(&words) {
                assert!(!error.use_stderr(), "`{name}`: {}: {error}", words.join(" "));
            }
        }
    }
}

#[test]
fn every_verb_has_a_page_and_every_shell_its_completions() {
    let folder = tempfile::tempdir().unwrap();
    man(&ManArgs { verb: vec![], out: Some(folder.path().to_owned()) }).unwrap();
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).unwrap();
    for (name, _) in verbs() {
        let page = read(&format!("{}.1", name.replace(' ', "-")));
        assert!(
            page.contains(".SH NAME") && page.contains(".SH SYNOPSIS") && page.contains(".TH "),
            "{name}"
        );
    }
    assert!(read("shoal.1").contains("shoal\\-plot(1)"));
    assert!(!folder.path().join("shoal-channel.1").exists());
    assert_eq!(page(&built()).unwrap(), read("shoal.1").into_bytes());
    for shell in Shell::value_variants() {
        let mut text = Vec::new();
        clap_complete::generate(*shell, &mut Cli::command(), "shoal", &mut text);
        let text = String::from_utf8(text).unwrap();
        assert!(text.contains("localize") && text.contains("at-s"), "{shell}");
    }
}

#[test]
fn an_unknown_verb_is_refused_with_the_known_ones() {
    let refused = |verb: &[&str]| {
        let verb = verb.iter().map(|word| (*word).to_owned()).collect();
        man(&ManArgs { verb, out: None }).unwrap_err()
    };
    let failure = refused(&["plott"]);
    assert!(failure.exit == Exit::Usage && failure.message.contains("plot, report"), "{failure:?}");
    assert!(refused(&["plot", "losses"]).message.contains("has no verbs"));
}
