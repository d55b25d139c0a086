# FRETWORK_SANITIZE=address,undefined or thread: instruments the whole build.
set(FRETWORK_SANITIZE "" CACHE STRING "Sanitizers to build with, as in -fsanitize=")
if(FRETWORK_SANITIZE)
  add_compile_options(-fsanitize=${FRETWORK_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${FRETWORK_SANITIZE})
endif()
# Coverage marks for libFuzzer in all libraries; the targets in tests/fuzz link its main().
if(FRETWORK_FUZZ)
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()
