# One shader: GLSL -> <STEM>.spv -> <STEM>.spv.h and <STEM>.d. Run with cmake -P; see palp_shader() for the arguments.
# glslangValidator --vn writes such a header too, but no binary then, and an array that is neither inline nor constexpr.
string(REPLACE "," ";" DEFINES "${DEFINES}")
list(TRANSFORM DEFINES PREPEND "-D")
execute_process(
    COMMAND "${GLSLANG}" --quiet --target-env vulkan1.2 "-I${ROOT}" ${DEFINES} --depfile "${STEM}.d" -o "${STEM}.spv" "${SOURCE}"
    RESULT_VARIABLE failure OUTPUT_VARIABLE messages ERROR_VARIABLE messages)
if(failure)
    file(REMOVE "${STEM}.spv" "${STEM}.spv.h")
    message("${messages}") # as it is; FATAL_ERROR would wrap the lines
    message(FATAL_ERROR "the shader ${NAME} does not compile")
endif()

# Little-endian bytes to words, eight to a line.
file(READ "${STEM}.spv" bytes HEX)
string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1," words "${bytes}")
string(REPEAT "0x........," 8 line)
string(REGEX REPLACE "(${line})" "    \\1\n" words "${words}")
file(WRITE "${STEM}.spv.h" "#pragma once\n#include <cstdint>\ninline constexpr std::uint32_t ${NAME}_spv[] = {\n${words}};\n")
