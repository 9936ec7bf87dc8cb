fn main() {
    let _ = glslang::Compiler::acquire();
}
