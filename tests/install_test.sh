#!/usr/bin/env bash
# Installs the library into folders of its own and builds strangers' projects against it.
# usage: install_test.sh BUILD_FOLDER TESTS_FOLDER CMAKE
set -euo pipefail
build=$1 tests=$2 cmake=$3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

build_consumer() {  # name, prefix, folder, options
  "$cmake" -S "$tests/$1" -B "$3" -DCMAKE_PREFIX_PATH="$2" -DCMAKE_BUILD_TYPE=Release "${@:4}" >"$folder/log" 2>&1 &&
    "$cmake" --build "$3" >>"$folder/log" 2>&1 || { cat "$folder/log"; return 1; }
}

echo "== Component core: at most 50 headers that include nothing else, and two packages"
"$cmake" --install "$build" --component core --prefix "$folder/core" >/dev/null
cd "$folder/core/include"
headers=$(find dynamic_icp -name '*.hpp')
[[ $(wc -l <<<"$headers") -le 50 ]]
sed 's/.*/#include "&"/' <<<"$headers" >"$folder/all.cpp"
no_package=()
for package in Threads PNG ZLIB nlohmann_json yaml-cpp embree; do
  no_package+=("-DCMAKE_DISABLE_FIND_PACKAGE_$package=ON")
done
build_consumer consumer_core "$folder/core" "$folder/plain" "${no_package[@]}"
eigen=$(grep -o -m1 -- '-isystem [^ ]*eigen3' "$build/compile_commands.json" | head -1 | cut -d' ' -f2)
compile=("${CXX:-c++}" -std=c++20 -fsyntax-only -I"$folder/core/include" -isystem "$eigen")
"${compile[@]}" -DEIGEN_MAX_STATIC_ALIGN_BYTES=16 "$folder/all.cpp"

echo "== The same trajectory whatever the flags of the consumer"
[[ $(uname -m) == x86_64 ]] && flags="-msse4.2" || flags="-march=native"
build_consumer consumer_core "$folder/core" "$folder/native" -DCMAKE_CXX_FLAGS="$flags -O3"
build_consumer consumer_core "$folder/core" "$folder/slow" -DCMAKE_BUILD_TYPE=Debug
"$build/dynamic-icp" simulate street --frames 6 --instant --set lidar.columns=300 --set lidar.rows=32 --quiet --output "$folder/street"
"$folder/plain/consumer_core" "$folder"/street/point_clouds/*.bin >"$folder/plain.txt"
"$folder/native/consumer_core" "$folder"/street/point_clouds/*.bin >"$folder/native.txt"
"$folder/slow/consumer_core" "$folder"/street/point_clouds/*.bin >"$folder/slow.txt"
[[ $(grep -c converged "$folder/plain.txt") -ge 8 ]]
diff "$folder/plain.txt" "$folder/native.txt"
diff "$folder/plain.txt" "$folder/slow.txt"

if [[ $(uname -m) == x86_64 ]]; then
  echo "== Another layout of Eigen's types is refused when it is compiled"
  ! "${compile[@]}" -mavx "$folder/all.cpp" 2>"$folder/refusal"
  grep -q 'EIGEN_MAX_STATIC_ALIGN_BYTES=16' "$folder/refusal"

  echo "== Other vectors than those of the library are refused when it is linked"
  ! build_consumer consumer_core "$folder/core" "$folder/avx" -DCMAKE_CXX_FLAGS="-mavx2 -mfma" >"$folder/refusal"
  grep -q 'compile_for_the_vector_instructions_of_the_library::avx_fma' "$folder/refusal"
fi

echo "== As a subproject: the method alone, and nothing of the parent is changed"
"$cmake" -S "$tests/consumer_subproject" -B "$folder/subproject" -DDYNAMIC_ICP_SOURCES="$tests/.." >"$folder/log" ||
  { cat "$folder/log"; exit 1; }

echo "== The whole installation, and the examples of docs/cpp.md"
"$cmake" --install "$build" --prefix "$folder/all" >/dev/null
build_consumer consumer "$folder/all" "$folder/io"
shared_io=$(find "$folder/all" -name 'libdynamic_icp_io.so')
[[ -z $shared_io ]] || ! ldd "$shared_io" | grep 'not found'
"$folder/all/bin/dynamic-icp" simulate street --frames 2 --quiet --output "$folder/two"
"$folder/io/consumer" "$folder/two" | tee "$folder/output"
[[ $(wc -l <"$folder/output") -eq 2 ]]
"$folder/io/callback" | tee "$folder/output"
grep -qE '^ok  position .* velocity +10(\.[0-9e-]+)? |^ok  position .* velocity +9\.9[0-9]* ' "$folder/output"
