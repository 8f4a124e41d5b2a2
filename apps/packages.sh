# Debian packages that lobefit needs, for apps/quickstart and tests/run (sourced by both).
build_packages=(
  g++ cmake ninja-build
  libboost-math-dev libceres-dev libeigen3-dev libhwy-dev libopencv-core-dev libopencv-imgproc-dev libopenexr-dev
  libpng-dev libjpeg-dev libtiff-dev zlib1g-dev libfreetype-dev fonts-dejavu-core libjemalloc-dev
  libcli11-dev nlohmann-json3-dev rapidjson-dev libtomlplusplus-dev libfmt-dev libpugixml-dev libssl-dev
)
test_packages=(
  libgtest-dev libgmock-dev libbenchmark-dev libvalijson-dev
  clang-14 clang-format-14 libclang-rt-14-dev
  python3 chromium glslang-tools
  slurmctld slurmd slurm-client munge
)

# install_missing PACKAGE...: installs those that are not there yet, as root or with sudo.
install_missing() {
  local missing=() package
  for package in "$@"; do
    dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
  done
  if [ ${#missing[@]} -eq 0 ]; then return; fi
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then as_root=(sudo); fi
  echo "installing: ${missing[*]}"
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get update -q >/dev/null
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}" >/dev/null
}
