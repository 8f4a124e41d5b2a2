// The version of the library and program, from the project's CMakeLists.txt.
#pragma once

namespace lobefit {

const char* Version();

}  // namespace lobefit
