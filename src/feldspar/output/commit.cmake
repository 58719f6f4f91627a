# Run at every build: writes OUTPUT with the commit of SOURCE_DIR, only if it changed. "unknown" outside a git checkout;
# "+changes" when tracked files differ from the commit.
set(commit "unknown")
find_program(GIT git)
if(GIT)
    execute_process(COMMAND ${GIT} -C ${SOURCE_DIR} rev-parse --show-toplevel
                    OUTPUT_VARIABLE top ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed)
    file(REAL_PATH "${SOURCE_DIR}" source_dir)
    if(NOT failed AND top STREQUAL source_dir)   # an unpacked archive inside somebody else's checkout has no commit
        execute_process(COMMAND ${GIT} -C ${SOURCE_DIR} rev-parse HEAD
                        OUTPUT_VARIABLE head ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed)
        if(NOT failed)
            set(commit "${head}")
            # --no-optional-locks: a build never competes for the index with somebody who commits
            execute_process(COMMAND ${GIT} --no-optional-locks -C ${SOURCE_DIR} status --porcelain --untracked-files=no
                            OUTPUT_VARIABLE changes ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
            if(changes)
                string(APPEND commit "+changes")
            endif()
        endif()
    endif()
endif()
set(text "// Written by commit.cmake at build time.\n#pragma once\n#define FELDSPAR_COMMIT \"${commit}\"\n")
set(before "")
if(EXISTS ${OUTPUT})
    file(READ ${OUTPUT} before)
endif()
if(NOT before STREQUAL text)
    file(WRITE ${OUTPUT} "${text}")
endif()
