# The headers refuse to be compiled with -ffast-math, and say why.
execute_process(
    COMMAND "${COMPILER}" -std=c++20 -ffast-math -fsyntax-only "-I${INCLUDE}" -x c++ "${SOURCE}"
    RESULT_VARIABLE code ERROR_VARIABLE message)
if(code EQUAL 0)
    message(FATAL_ERROR "-ffast-math was accepted")
elseif(NOT message MATCHES "compile without -ffast-math")
    message(FATAL_ERROR "refused without saying why:\n${message}")
endif()
