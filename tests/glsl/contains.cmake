# Fails unless FILE contains WANTED.
file(READ "${FILE}" text)
string(FIND "${text}" "${WANTED}" at)
if(at EQUAL -1)
    message(FATAL_ERROR "${FILE} does not contain: ${WANTED}")
endif()
