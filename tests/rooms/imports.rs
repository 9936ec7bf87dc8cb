//! Which file of src/ names what of which other: `use` lines, and paths in the code and in macros' arguments.
//!
//! A name leads to the file that defines it, however many modules hand it on. Tests at the end of a file do not count;
//! methods do not either, whose types' names do.

use proc_macro2::{TokenStream, TokenTree};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use syn::visit::{self, Visit};

/// `file` names `name`, which `target` defines, first in `line`.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Import {
    /// From src/.
    pub file: PathBuf,
    pub line: usize,
    /// From src/.
    pub target: PathBuf,
    pub name: String,
}

/// One of a file, or one that a file has in itself.
#[derive(Default)]
struct Module {
    file: PathBuf,
    children: BTreeMap<String, usize>,
    /// Names that other modules define, by their whole path.
    handed_on: BTreeMap<String, Vec<String>>,
    paths: Vec<(usize, Vec<String>)>,
}

struct Crate {
    modules: Vec<Module>,
}

/// Every import between two files below `src`, whose crate is called `name`.
pub fn imports(src: &Path, name: &str) -> Vec<Import> {
    let mut read = Crate { modules: vec![Module { file: "lib.rs".into(), ..Module::default() }] };
    read.file(src, 0, &src.join("lib.rs"), &mut Vec::new(), name);
    let mut found: BTreeMap<(PathBuf, PathBuf, String), usize> = BTreeMap::new();
    for module in &read.modules {
        for (line, path) in &module.paths {
            let Some((target, name)) = read.defined(path, 0) else { continue };
            if target != module.file {
                let first = found.entry((module.file.clone(), target, name)).or_insert(*line);
                *first = (*first).min(*line);
            }
        }
    }
    found.into_iter().map(|((file, target, name), line)| Import { file, line, target, name }).collect()
}

impl Crate {
    /// Reads module `index`, which lies in `path`; `inside`: its name, from the crate's root.
    fn file(&mut self, src: &Path, index: usize, path: &Path, inside: &mut Vec<String>, name: &str) {
        let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let tree = syn::parse_file(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        self.items(src, index, &tree.items, inside, name);
    }

    fn items(&mut self, src: &Path, index: usize, items: &[syn::Item], inside: &mut Vec<String>, name: &str) {
        let mut reader = Reader { known: BTreeMap::new(), inside: inside.clone(), name, paths: Vec::new() };
        // What is defined here hides what else is called so; children are named from here.
        for item in items.iter().filter(|item| !is_test(item)) {
            if let syn::Item::Mod(child) = item {
                let child = child.ident.to_string();
                reader.known.insert(child.clone(), [&inside[..], &[child]].concat());
            }
        }
        for item in items.iter().filter(|item| !is_test(item)) {
            if let syn::Item::Use(line) = item {
                let is_handed_on = !matches!(line.vis, syn::Visibility::Inherited);
                for (name, whole) in reader.used(&line.tree) {
                    reader.known.insert(name.clone(), whole.clone());
                    if is_handed_on {
                        self.modules[index].handed_on.insert(name, whole);
                    }
                }
            }
        }
        for item in items.iter().filter(|item| !is_test(item)) {
            match item {
                syn::Item::Mod(child) => {
                    let child_name = child.ident.to_string();
                    let next = self.modules.len();
                    inside.push(child_name.clone());
                    self.modules[index].children.insert(child_name, next);
                    match &child.content {
                        Some((_, items)) => {
                            let file = self.modules[index].file.clone();
                            self.modules.push(Module { file, ..Module::default() });
                            self.items(src, next, items, inside, name);
                        }
                        None => {
                            let file = file_of(src, inside);
                            let from_src = file.strip_prefix(src).unwrap().to_owned();
                            self.modules.push(Module { file: from_src, ..Module::default() });
                            self.file(src, next, &file, inside, name);
                        }
                    }
                    inside.pop();
                }
                syn::Item::Use(line) if !matches!(line.vis, syn::Visibility::Inherited) => {}
                item => reader.visit_item(item),
            }
        }
        self.modules[index].paths = reader.paths;
    }

    /// The file that defines what a path from the crate's root names, and its name; nothing for a module by itself,
    /// which imports nothing until something of it is named.
    fn defined(&self, path: &[String], depth: usize) -> Option<(PathBuf, String)> {
        let mut module = 0;
        for (place, word) in path.iter().enumerate() {
            if let Some(child) = self.modules[module].children.get(word) {
                module = *child;
            } else if let Some(whole) = self.modules[module].handed_on.get(word).filter(|_| depth < 8) {
                return self.defined(&[whole, &path[place + 1..]].concat(), depth + 1);
            } else {
                return Some((self.modules[module].file.clone(), word.clone()));
            }
        }
        None
    }
}

fn is_test(item: &syn::Item) -> bool {
    let attributes = match item {
        syn::Item::Mod(item) => &item.attrs,
        syn::Item::Use(item) => &item.attrs,
        syn::Item::Fn(item) => &item.attrs,
        syn::Item::Impl(item) => &item.attrs,
        _ => return false,
    };
    attributes.iter().any(|attribute| match &attribute.meta {
        syn::Meta::List(list) => list.path.is_ident("cfg") && list.tokens.to_string() == "test",
        _ => false,
    })
}

fn file_of(src: &Path, inside: &[String]) -> PathBuf {
    let folder = inside.iter().fold(src.to_owned(), |path, word| path.join(word));
    let file = folder.with_extension("rs");
    if file.exists() { file } else { folder.join("mod.rs") }
}

struct Reader<'a> {
    /// What a name means here, from the crate's root.
    known: BTreeMap<String, Vec<String>>,
    inside: Vec<String>,
    name: &'a str,
    paths: Vec<(usize, Vec<String>)>,
}

impl Reader<'_> {
    /// A path from the crate's root, if it is of this crate.
    fn whole(&self, path: &[String]) -> Option<Vec<String>> {
        let (first, rest) = path.split_first()?;
        match first.as_str() {
            "crate" => Some(rest.to_vec()),
            "self" if !rest.is_empty() => Some([&self.inside[..], rest].concat()),
            "super" => {
                let mut inside = self.inside.clone();
                let mut rest = path;
                while rest.first().is_some_and(|word| word == "super") {
                    inside.pop();
                    rest = &rest[1..];
                }
                Some([&inside[..], rest].concat())
            }
            word if word == self.name => Some(rest.to_vec()),
            word => self.known.get(word).map(|whole| [&whole[..], rest].concat()),
        }
    }

    /// Names that a `use` line brings, each with its path from the crate's root.
    fn used(&self, tree: &syn::UseTree) -> Vec<(String, Vec<String>)> {
        let mut found = Vec::new();
        leaves(tree, &mut Vec::new(), &mut found);
        let whole = |(name, path): (String, Vec<String>)| Some((name, self.whole(&path)?));
        found.into_iter().filter_map(whole).collect()
    }

    fn name(&mut self, line: usize, path: &[String]) {
        if let Some(whole) = self.whole(path) {
            self.paths.push((line, whole));
        }
    }

    /// Paths in what a macro is given, which is not parsed.
    fn tokens(&mut self, tokens: TokenStream) {
        let mut path: Vec<String> = Vec::new();
        let (mut line, mut colons) = (0, 0);
        for token in tokens {
            match token {
                TokenTree::Ident(word) => {
                    if colons != 2 {
                        self.name(line, &std::mem::take(&mut path));
                        line = word.span().start().line;
                    }
                    path.push(word.to_string());
                    colons = 0;
                }
                TokenTree::Punct(mark) if mark.as_char() == ':' => colons += 1,
                TokenTree::Group(group) => {
                    self.name(line, &std::mem::take(&mut path));
                    colons = 0;
                    self.tokens(group.stream());
                }
                _ => {
                    self.name(line, &std::mem::take(&mut path));
                    colons = 0;
                }
            }
        }
        self.name(line, &path);
    }
}

fn leaves(tree: &syn::UseTree, path: &mut Vec<String>, found: &mut Vec<(String, Vec<String>)>) {
    match tree {
        syn::UseTree::Path(step) => {
            path.push(step.ident.to_string());
            leaves(&step.tree, path, found);
            path.pop();
        }
        syn::UseTree::Name(name) if name.ident == "self" => found.push((path[path.len() - 1].clone(), path.clone())),
        syn::UseTree::Name(name) => {
            let name = name.ident.to_string();
            found.push((name.clone(), [&path[..], &[name]].concat()));
        }
        syn::UseTree::Rename(name) => {
            found.push((name.rename.to_string(), [&path[..], &[name.ident.to_string()]].concat()));
        }
        syn::UseTree::Group(group) => group.items.iter().for_each(|tree| leaves(tree, path, found)),
        syn::UseTree::Glob(_) => {}
    }
}

impl<'ast> Visit<'ast> for Reader<'_> {
    fn visit_path(&mut self, path: &'ast syn::Path) {
        let words: Vec<String> = path.segments.iter().map(|segment| segment.ident.to_string()).collect();
        let line = path.segments[0].ident.span().start().line;
        self.name(line, &words);
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, called: &'ast syn::Macro) {
        self.visit_path(&called.path);
        self.tokens(called.tokens.clone());
    }

    fn visit_item_use(&mut self, line: &'ast syn::ItemUse) {
        for (_, whole) in self.used(&line.tree) {
            self.paths.push((line.use_token.span.start().line, whole));
        }
    }

    fn visit_item_macro(&mut self, item: &'ast syn::ItemMacro) {
        self.visit_macro(&item.mac);
    }
}

/// Sets of files that name each other in a circle: each reaches every other by arrows.
pub fn circles<T: Ord + Clone>(arrows: &BTreeSet<(T, T)>) -> Vec<Vec<T>> {
    let mut reaches: BTreeMap<T, BTreeSet<T>> = BTreeMap::new();
    for (from, to) in arrows {
        reaches.entry(from.clone()).or_default().insert(to.clone());
    }
    let reached = |start: &T| {
        let mut seen = BTreeSet::new();
        let mut open = vec![start.clone()];
        while let Some(at) = open.pop() {
            for next in reaches.get(&at).into_iter().flatten() {
                if seen.insert(next.clone()) {
                    open.push(next.clone());
                }
            }
        }
        seen
    };
    let all: BTreeMap<T, BTreeSet<T>> = reaches.keys().map(|start| (start.clone(), reached(start))).collect();
    let circle = |start: &T| -> Vec<T> {
        let is_in = |other: &&T| all.get(*other).is_some_and(|back| back.contains(start));
        all[start].iter().filter(is_in).cloned().collect()
    };
    let found: BTreeSet<Vec<T>> = reaches.keys().map(circle).filter(|circle| !circle.is_empty()).collect();
    found.into_iter().collect()
}
