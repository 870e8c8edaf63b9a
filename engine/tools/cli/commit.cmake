# Writes HEADER, which names the commit of SOURCE, if it does not name it yet. "unknown" without git or a repository.
find_program(git NAMES git)
set(commit "unknown")
if(git)
    execute_process(COMMAND "${git}" describe --always --dirty --abbrev=12 --exclude=* WORKING_DIRECTORY "${SOURCE}"
        OUTPUT_VARIABLE found RESULT_VARIABLE failed ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
    if(NOT failed AND found)
        set(commit "${found}")
    endif()
endif()
file(CONFIGURE OUTPUT "${HEADER}" CONTENT "#pragma once\n#define PALPATE_COMMIT \"${commit}\"\n" @ONLY)
