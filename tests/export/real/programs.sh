# What `run` compiles against the programs that the user has built; sourced by it, with $here and $work set.

# Compile flags of a source of a CMake build, by the end of its name.
flags_of() {
  [ -f "$1/compile_commands.json" ] || cmake -DCMAKE_EXPORT_COMPILE_COMMANDS=ON "$1" >/dev/null 2>&1
  python3 - "$1/compile_commands.json" "$2" <<'END'
import json, shlex, sys
entry = next(e for e in json.load(open(sys.argv[1])) if e["file"].endswith(sys.argv[2]))
words, skip = shlex.split(entry["command"]), False
words = words[next(k for k, w in enumerate(words) if w.startswith("-")):]
kept = [w for k, w in enumerate(words) if w not in ("-c", "-o") and words[k - 1] not in ("-c", "-o")]
print(" ".join(map(shlex.quote, kept)))
END
}

# testBSDF and checkBSDF need nothing but the folder src/common.
build_radiance() {
  local sources=$1/src/common bin=$1/lobefit-bin flags="-O1 -w -std=gnu11 -D_GNU_SOURCE -I$1/src/common"
  mkdir -p "$bin/objects"
  find "$sources" -maxdepth 1 -name '*.c' ! -name 'test*' -print0 |
    xargs -0 -P "$(nproc)" -I{} sh -c 'gcc '"$flags"' -c "{}" -o "'"$bin"'/objects/$(basename "{}").o" 2>/dev/null || true'
  ar rc "$bin/lib.a" "$bin"/objects/*.o
  gcc $flags "$sources/testBSDF.c" -o "$bin/testBSDF" "$bin/lib.a" -lm
  gcc $flags "$1/src/cv/checkBSDF.c" -o "$bin/checkBSDF" "$bin/lib.a" -lm
}

# compile_NAME FOLDER: our driver NAME.cc as build/lobefit-NAME of that folder, where it is older. LDFLAGS are added.
compile_pbrt() {
  local build=$1/build
  [ "$build/lobefit-pbrt" -nt "$here/pbrt.cc" ] && return
  eval "${CXX:-g++} $(flags_of "$build" src/pbrt/materials.cpp)" '"$here/pbrt.cc"' -o '"$build/lobefit-pbrt"' \
    '-Wl,--start-group "$build/libpbrt_lib.a" $(find "$build/src" -name "lib*.a" ! -name "libOpenGL*") -Wl,--end-group' \
    -lOpenEXR -lIex -lIlmThread -lImath -lz -lGL -lX11 -ldl -lpthread ${LDFLAGS:-}
}

compile_powitacq() { ${CXX:-g++} -O2 -std=c++17 -I"$1" "$here/powitacq.cc" -o "$work/powitacq"; }

compile_gles() { ${CXX:-g++} -O1 -std=c++17 "$here/gles.cc" -o "$work/gles" -lEGL -lGLESv2 2>/dev/null; }

# Its loader alone, which needs Qt's headers.
compile_brdf_explorer() {
  local sources=$1/src/brdf
  [ "$sources/lobefit-brdf-explorer" -nt "$here/brdf_explorer.cc" ] && return
  (cd "$sources" && ${CXX:-g++} -O1 -w -fPIC -DPTEX_STATIC -I. $(pkg-config --cflags Qt5Widgets Qt5OpenGL) \
    "$here/brdf_explorer.cc" BRDFBase.cpp BRDFAnalytic.cpp BRDFImageSlice.cpp BRDFMeasuredAniso.cpp BRDFMeasuredMERL.cpp \
    DGLShader.cpp Paths.cpp SharedContextGLWidget.cpp glerror.cpp -o lobefit-brdf-explorer \
    $(pkg-config --libs Qt5Widgets Qt5OpenGL) ${LDFLAGS:-})
}

compile_mitsuba() {
  local build=$1/build
  [ "$build/lobefit-mitsuba" -nt "$here/mitsuba.cc" ] && return
  eval "${CXX:-g++} $(flags_of "$build" src/core/parser.cpp)" '"$here/mitsuba.cc"' -o '"$build/lobefit-mitsuba"' \
    '-L"$build"' '-Wl,-rpath,"$build"' -lmitsuba '$(find "$build" -maxdepth 1 -name "libnanothread.so")' -ldl -lpthread ${LDFLAGS:-}
}
