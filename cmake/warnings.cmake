# Warnings and floating-point rules in one target. Contraction into fused multiply-adds is off because
# it would make results depend on the compiler and the instruction set; see docs/determinism.md.
# Warnings stop the build, except under a sanitizer: its instrumentation leads g++ to warn of uninitialised
# values and array bounds inside the standard library and Eigen.
set(warnings_stop -Werror)
if(FRETWORK_SANITIZE)
  set(warnings_stop "")
endif()
add_library(project_warnings INTERFACE)
target_compile_options(project_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wshadow ${warnings_stop} -ffp-contract=off)
