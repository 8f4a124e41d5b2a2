# The headers that are installed: what a program outside calls, and what those include. All others are the library's own
# business. `cmake --build ... --target lobefit_library_verify_interface_header_sets` compiles each alone.
set(entrances
  batch/run/run.h
  core/brdf/brdf.h
  core/brdf/model_energy.h
  export/export.h
  export/import.h
  fit/automatic.h
  fit/compare.h
  fit/fit.h
  fit/fit_many.h
  io/read.h
  io/write.h
  material/json.h
  quantities/quantities.h
  recipe/recipe.h
  report/report.h
  report/web/html.h
  synthesis/synthesis.h
  validate/experiment.h)

set(public_dir ${PROJECT_BINARY_DIR}/include/public)
set(waiting ${entrances})
set(public_headers)
while(waiting)
  list(POP_FRONT waiting header)
  if(header IN_LIST public_headers)
    continue()
  endif()
  list(APPEND public_headers ${header})
  # A change of what it includes configures anew.
  configure_file(${CMAKE_CURRENT_SOURCE_DIR}/${header} ${public_dir}/lobefit/${header} COPYONLY)
  file(STRINGS ${header} includes REGEX "^#include \"lobefit/")
  list(TRANSFORM includes REPLACE "^#include \"lobefit/([^\"]+)\".*" "\\1")
  list(APPEND waiting ${includes})
endwhile()
list(TRANSFORM public_headers PREPEND ${public_dir}/lobefit/)
# What is public no longer goes; the rest keeps its time, so that a new configuration compiles nothing again.
file(GLOB_RECURSE present ${public_dir}/*.h)
list(REMOVE_ITEM present ${public_headers})
if(present)
  file(REMOVE ${present})
endif()
target_sources(lobefit_library INTERFACE FILE_SET HEADERS BASE_DIRS ${public_dir} FILES ${public_headers})
set_target_properties(lobefit_library PROPERTIES VERIFY_INTERFACE_HEADER_SETS ON)
