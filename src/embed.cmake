# cmake -DINPUT=FILE -DOUTPUT=FILE -DNAME=NAME -P embed.cmake: C++ that defines lobefit::NAME as the text of INPUT.
file(READ "${INPUT}" text)
string(FIND "${text}" ")embedded\"" end)
if(NOT end EQUAL -1)
  message(FATAL_ERROR "${INPUT} holds )embedded\", which ends the string that it becomes")
endif()
file(WRITE "${OUTPUT}" "#include <string_view>

namespace lobefit {

extern const std::string_view ${NAME};
const std::string_view ${NAME} = R\"embedded(${text})embedded\";

}  // namespace lobefit
")
