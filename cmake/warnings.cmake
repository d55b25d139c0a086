# Warnings and floating-point rules in one target. Contraction into fused multiply-adds is off because
# it would make results depend on the compiler and the instruction set; see docs/determinism.md.
add_library(project_warnings INTERFACE)
target_compile_options(project_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror -ffp-contract=off)
