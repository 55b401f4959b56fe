# Run at every build: writes OUTPUT from INPUT with the commit of SOURCE; an unchanged file is left alone.
execute_process(COMMAND git -C ${SOURCE} describe --always --abbrev=12 --dirty --exclude=*
  OUTPUT_VARIABLE COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE status)
if(NOT status EQUAL 0)
  set(COMMIT "unknown")
endif()
configure_file(${INPUT} ${OUTPUT} @ONLY)
