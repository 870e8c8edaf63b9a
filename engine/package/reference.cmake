# The reference, made of the comments in the headers that are installed: cmake --build build --target reference writes
# reference/c and reference/cpp in the build folder. Included once all layers have named their headers.
find_package(Doxygen QUIET)
if(NOT DOXYGEN_FOUND)
    return()
endif()

set(DOXYGEN_QUIET YES)
set(DOXYGEN_WARN_AS_ERROR FAIL_ON_WARNINGS)
set(DOXYGEN_HAVE_DOT NO) # pictures of includes say nothing, and are what takes long
set(DOXYGEN_JAVADOC_AUTOBRIEF YES)
set(DOXYGEN_STRIP_FROM_PATH "${PROJECT_SOURCE_DIR}")
set(DOXYGEN_PROJECT_NUMBER "${PROJECT_VERSION}")

# For C nothing may lack its sentence.
set(DOXYGEN_PROJECT_NAME "palpate.h")
set(DOXYGEN_PROJECT_BRIEF "Touch of soft, thin objects, for C and what calls C")
set(DOXYGEN_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/reference/c")
set(DOXYGEN_OPTIMIZE_OUTPUT_FOR_C YES)
set(DOXYGEN_TYPEDEF_HIDES_STRUCT YES)
set(DOXYGEN_MACRO_EXPANSION YES)
set(DOXYGEN_EXPAND_ONLY_PREDEF YES)
set(DOXYGEN_PREDEFINED "PALPATE_API=")
doxygen_add_docs(reference_c "${PROJECT_SOURCE_DIR}/engine/capi/palpate.h")

# For C++ names that say all need no comment, and a tag that would say nothing is omitted: see CONTRIBUTING.md.
set(DOXYGEN_PROJECT_NAME "Palpate in C++")
set(DOXYGEN_PROJECT_BRIEF "${PROJECT_DESCRIPTION}")
set(DOXYGEN_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/reference/cpp")
set(DOXYGEN_OPTIMIZE_OUTPUT_FOR_C NO)
set(DOXYGEN_TYPEDEF_HIDES_STRUCT NO)
set(DOXYGEN_BUILTIN_STL_SUPPORT YES)
set(DOXYGEN_EXTRACT_ALL YES)
set(DOXYGEN_WARN_IF_INCOMPLETE_DOC NO)
set(DOXYGEN_USE_MDFILE_AS_MAINPAGE "${CMAKE_CURRENT_LIST_DIR}/reference.md")
set(DOXYGEN_ALIASES [[thread=\par Threads^^]] [[source=\par Source^^]] [[differs=\par Differs^^]])
get_property(headers GLOBAL PROPERTY PALPATE_PUBLIC_HEADERS)
list(TRANSFORM headers PREPEND "${PROJECT_SOURCE_DIR}/")
doxygen_add_docs(reference_cpp "${CMAKE_CURRENT_LIST_DIR}/reference.md" ${headers})

add_custom_target(reference DEPENDS reference_c reference_cpp)
