# Writes the bytes of the guardian's executable as a header. Run with cmake -P -DPROGRAM=... -DHEADER=...
file(READ "${PROGRAM}" bytes HEX)
string(REGEX REPLACE "(..)" "0x\\1," bytes "${bytes}")
string(REPEAT "0x..," 24 line)
string(REGEX REPLACE "(${line})" "    \\1\n" bytes "${bytes}")
file(WRITE "${HEADER}" "#pragma once\ninline constexpr unsigned char kGuardianImage[] = {\n${bytes}};\n")
