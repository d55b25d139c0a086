# FRETWORK_SANITIZE=address,undefined or thread: instruments the whole build. What belongs to other
# libraries is named, with the reason, in cmake/sanitizers; the test preset passes that file on.
set(FRETWORK_SANITIZE "" CACHE STRING "Sanitizers to build with, as in -fsanitize=")
if(FRETWORK_SANITIZE)
  add_compile_options(-fsanitize=${FRETWORK_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${FRETWORK_SANITIZE})
endif()
# uninstrumented_threads(<source>): the one file that holds the templates of the thread library. Half of
# that library, instrumented here, and half, not instrumented in its shared object, would only give false
# races; the file tells the sanitizer itself what its loops promise.
function(uninstrumented_threads source)
  if(FRETWORK_SANITIZE MATCHES "thread")
    set_source_files_properties(${source} PROPERTIES COMPILE_OPTIONS -fno-sanitize=thread
                                COMPILE_DEFINITIONS FRETWORK_THREAD_SANITIZER)
  endif()
endfunction()
# Coverage marks for libFuzzer in all libraries; the targets in tests/fuzz link its main().
if(FRETWORK_FUZZ)
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()
