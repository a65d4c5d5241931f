#!/usr/bin/env bash
# The one door to this repository: installs what is missing, builds, runs. See `./run.sh help`.
set -euo pipefail

root=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
jobs=$(nproc)
install=yes

usage() {
    cat <<'TEXT'
usage: ./run.sh [--no-install] [-j N] COMMAND

  demo       build warpshadow-lab, render the built-in scenes, write report/report.html
  lab ...    build warpshadow-lab and pass it the arguments (lab --help lists them)
  view ...   build the interactive viewer and pass it the arguments
  test       everything that has to pass: GCC, Clang, sanitizers, formatting, consumers
  nightly    unit and property tests at -O0 to -O3 with fresh seeds; builds the benchmarks
  bench ...  build the benchmarks and run all, or the named one with the arguments that follow
  docs       build the reference in build/docs
  first-light  measure again what the first block of README.md shows, and write it
  figures    measure again what docs/bias.md shows of Scherzer's figures, and write it
  geometry   measure again what docs/geometry.md shows, and write it; wants an idle machine
  point-lights  measure again what docs/point-lights.md shows, and write it
  help       this text

  --no-install   never install a Debian package; say which are missing instead
  -j N           build and test with N processes (default: one per core)

Works from any directory, needs neither a display nor a GPU.
TEXT
}

die() {
    printf 'run.sh: %s\n' "$*" >&2
    exit 1
}

# Packages ---------------------------------------------------------------------------------------

# Names of the packages of the given groups of packages.txt that are not installed.
missing_packages() {
    local names
    names=$(awk -v groups=" $* " '!/^ *#/ && NF && index(groups, " " $1 " ") { print $2 }' \
        "$root/packages.txt")
    comm -23 <(sort -u <<<"$names") \
        <(dpkg-query --show --showformat='${db:Status-Status} ${Package}\n' |
            awk '$1 == "installed" { print $2 }' | sort -u)
}

# Installs what is missing of the given groups.
need() {
    if ! command -v dpkg-query >/dev/null; then
        printf 'run.sh: not a Debian system; packages.txt lists what is needed (%s)\n' "$*" >&2
        return
    fi
    local missing
    mapfile -t missing < <(missing_packages "$@")
    ((${#missing[@]})) || return 0
    local as_root=()
    if [[ $install == no ]]; then
        die "missing packages, and --no-install was given: ${missing[*]}"
    elif ((EUID != 0)); then
        command -v sudo >/dev/null ||
            die "missing packages, and neither root nor sudo to install them: ${missing[*]}"
        as_root=(sudo)
    fi
    local apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -y
        -o Dpkg::Use-Pty=0)
    printf 'installing %s\n' "${missing[*]}"
    # The package lists of a fresh machine may be absent or too old: fetch them only then.
    if ! "${apt[@]}" install --no-install-recommends "${missing[@]}" >/dev/null 2>&1 </dev/null; then
        "${apt[@]}" update >/dev/null || die "apt-get update failed"
        "${apt[@]}" install --no-install-recommends "${missing[@]}" >/dev/null </dev/null ||
            die "apt-get could not install: ${missing[*]}"
    fi
}

# Stages of `test` -------------------------------------------------------------------------------

passed=0
failed=0
skipped=0

# stage TITLE COMMAND...: runs the command with its output in build/logs; one line, and the end of
# the output if it failed.
stage() {
    local title=$1 start=$SECONDS code=0
    shift
    log="$root/build/logs/$(tr -sc 'A-Za-z0-9\n' - <<<"$title").log"
    mkdir -p "$root/build/logs"
    printf '%-44s' "$title"
    (cd "$root" && "$@") >"$log" 2>&1 </dev/null || code=$?
    if ((code == 0)); then
        printf '%-7s%5d s\n' ok $((SECONDS - start))
    else
        printf '%-7s%5d s\n' FAILED $((SECONDS - start))
        # Of a test run, what failed.
        grep -vE '^ *Start +[0-9]+: |Passed +[0-9.]+ sec' "$log" | tail -n 300
        printf 'whole output: %s\n' "$log"
    fi
    return $code
}

# A stage that counts as one test.
check() {
    if stage "$@"; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        return 1
    fi
}

# Configures and builds a preset; a failure counts as a failed test.
build() {
    local title=$1 preset=$2
    stage "$title: configure" cmake --preset "$preset" &&
        stage "$title: build" cmake --build --preset "$preset" --parallel "$jobs" -- -k 0 ||
        { failed=$((failed + 1)) && return 1; }
}

# Runs ctest on a preset and adds up its counts.
run_ctest() {
    local title=$1 preset=$2 code=0
    stage "$title: tests" ctest --preset "$preset" --parallel "$jobs" || code=$?
    local total=0 bad=0 idle=0
    if [[ $(grep -E '^[0-9]+% tests passed' "$log") =~ ,\ ([0-9]+)\ tests?\ failed\ out\ of\ ([0-9]+) ]]; then
        bad=${BASH_REMATCH[1]}
        total=${BASH_REMATCH[2]}
        idle=$(grep -cE '^ *[0-9]+/[0-9]+ Test .*\*\*\*Skipped' "$log") || true
        printf '    %d passed, %d failed, %d skipped\n' $((total - bad - idle)) "$bad" "$idle"
        sed -n '/^The following tests did not run/,/^$/s/^\t/    skipped: /p' "$log"
    fi
    # A run that ended without counts, or with an error that no test explains, is a failure too.
    if ((code != 0 && bad == 0)) || ((total == 0)); then
        bad=$((bad + 1))
        total=$((total + 1))
    fi
    passed=$((passed + total - bad - idle))
    failed=$((failed + bad))
    skipped=$((skipped + idle))
    return $code
}

# The last line that `test` and `nightly` print, and their exit code.
summary() {
    printf '%d passed, %d failed, %d skipped\n' "$passed" "$failed" "$skipped"
    ((failed == 0 && passed > 0))
}

# Commands ---------------------------------------------------------------------------------------

# Builds one target of the release preset, quietly; shows the output only if that fails.
release() {
    local target=$1
    local log="$root/build/logs/release-$target.log"
    mkdir -p "$root/build/logs"
    (cd "$root" && cmake --preset release && cmake --build --preset release --parallel "$jobs" \
        --target "$target") >"$log" 2>&1 </dev/null || {
        tail -n 60 "$log" >&2
        die "could not build $target (whole output: $log)"
    }
}

# Runs the lab headless: Mesa's software renderer serves where there is no GPU.
lab() {
    need build lab samples
    release warpshadow-lab
    "$root/build/release/bin/warpshadow-lab" "$@"
}

command_demo() {
    printf 'building warpshadow-lab ...\n'
    lab --out report
}

command_lab() {
    lab "$@"
}

command_view() {
    need build lab samples
    release warpshadow-view
    exec "$root/build/release/bin/warpshadow-view" "$@"
}

command_test() {
    local groups=(build lab samples test generator)
    need "${groups[@]}"
    # One seed for every run, so that a failure can be repeated; `nightly` draws fresh ones.
    export RC_PARAMS=${RC_PARAMS-seed=2015}
    local builds=()
    if build "GCC, Release" ci; then
        builds+=(build/ci)
        run_ctest "GCC, Release" ci || true
    fi
    if build "Clang, ASan and UBSan" asan; then
        builds+=(build/asan)
        run_ctest "Clang, ASan and UBSan" asan || true
    fi
    # What was not built would show up as packages that nothing needs.
    if ((${#builds[@]} == 2)); then
        check "Debian packages" python3 tests/repository/check_packages.py \
            "$(IFS=,; printf %s "${groups[*]}")" "${builds[@]}" || true
    fi
    summary
}

command_nightly() {
    need build lab samples test bench
    local level
    for level in -O0 -O1 -O2 -O3; do
        export WARPSHADOW_NIGHTLY_OPT=$level
        build "GCC, $level" nightly && run_ctest "GCC, $level" nightly || true
    done
    check "Benchmarks: configure" cmake --preset release -D WARPSHADOW_BUILD_BENCH=ON &&
        check "Benchmarks: build" cmake --build --preset release --parallel "$jobs" &&
        check "Debian packages of the benchmarks" python3 tests/repository/check_packages.py \
            build,lab,samples,bench build/release || true
    summary
}

# bench: all of them; bench NAME ARGUMENT...: one. The benchmarks share test inputs and results
# formats with tests and lab, hence those groups.
command_bench() {
    need build lab samples test bench
    (cd "$root" && cmake --preset release -D WARPSHADOW_BUILD_BENCH=ON) >/dev/null
    release warpshadow-benchmarks
    local folder=$root/build/release/bench program
    if (($#)); then
        program=$folder/$1
        [[ -f $program && -x $program ]] || die "no benchmark $1 (they are in bench/)"
        "$program" "${@:2}"
        return
    fi
    for program in "$folder"/*; do
        if [[ -f $program && -x $program ]]; then
            printf '\n%s\n' "${program##*/}"
            "$program"
        fi
    done
}

command_docs() {
    need docs
    mkdir -p "$root/build/docs"
    (cd "$root" && doxygen docs/Doxyfile)
    printf 'build/docs/html/index.html\n'
}

command_first-light() {
    local folder=$root/docs/first-light
    lab --methods sm,dv,fitted,notw,raytraced --out "$root/build/first-light"
    cp "$root/build/first-light/results.json" "$folder/results.json"
    local method
    for method in sm notw; do
        cp "$root/build/first-light/outdoor-c0-l0-m512-$method.png" "$folder/outdoor-$method.png"
    done
    python3 "$folder/write_readme.py"
}

command_figures() {
    local folder=$root/docs/bias figure
    for figure in figure6 figure8; do
        lab --preset "$figure" --out "$root/build/$figure"
        cp "$root/build/$figure/results.json" "$folder/$figure.json"
    done
    python3 "$folder/write_page.py"
}

command_geometry() {
    need build lab samples test bench
    local folder=$root/docs/geometry out=$root/build/geometry name
    local bench=$root/build/release/bench
    mkdir -p "$out"
    (cd "$root" && cmake --preset release -D WARPSHADOW_BUILD_BENCH=ON) >/dev/null
    for name in geometry_failures geometry_fits geometry_bench geometry_bench_native; do
        printf 'building %s ...\n' "$name"
        release "bench_$name"
    done
    "$bench/geometry_fits" "$folder/fits.json" "$folder/fit.svg"
    printf 'counting failures ...\n'
    WARPSHADOW_SETS=400 "$bench/geometry_failures" "$out/failures.md" "$folder/failures.json"
    for name in geometry_bench geometry_bench_native; do
        printf 'timing %s ...\n' "$name"
        "$bench/$name" --benchmark_enable_random_interleaving=true --benchmark_repetitions=15 \
            --benchmark_min_time=0.02 --benchmark_out="$out/$name.json" >/dev/null
    done
    python3 "$folder/collect.py" speed "$out/geometry_bench.json" "$out/geometry_bench_native.json"
    lab --methods sm,stable,min-sm,dv --out "$out"
    python3 "$folder/collect.py" frames "$out/results.json"
    python3 "$folder/write_page.py"
}

command_point-lights() {
    local folder=$root/docs/point-lights out=$root/build/point-lights name
    need build lab samples test bench
    rm -rf "$out"
    mkdir -p "$out"
    printf 'building the lab, two benchmarks and two tests ...\n'
    (cd "$root" && cmake --preset release -D WARPSHADOW_BUILD_BENCH=ON && cmake --preset ci) >/dev/null
    release bench_omni_culling
    release bench_omni_culling_native
    (cd "$root" && cmake --build --preset ci --parallel "$jobs" --target property_cull_test lab_omni) \
        >/dev/null
    # The paper's walk, with a light above the views; and a lamp that most views see.
    local six=cube6,cube6-cull,cube6-efc,dpsm,dpsm-cull,dpsm-pc
    local walk=(--path walk --view 320x240)
    local above=point:-1.9,2.7,1.6 lamp=point:0.2,1.97,-0.1
    lab "${walk[@]}" --scene interior:600000 --light=$above --frames 20 --map 1024,2048 \
        --methods $six --out "$out/walk-600k"
    lab "${walk[@]}" --scene interior:600000 --light=$lamp --frames 10 --map 1024 \
        --methods $six --out "$out/walk-lamp"
    lab "${walk[@]}" --scene interior:3000000 --light=$above --frames 4 --map 1024 \
        --methods $six,cube6-gs,cube6-cull-gs,dpsm-gs,dpsm-cull-gs --out "$out/walk-3m"
    lab --preset vpl:100000 --out "$out/vpl-100k"
    lab --preset vpl:3000000 --out "$out/vpl-3m"
    for name in omni_culling omni_culling_native; do
        "$root/build/release/bench/$name" --benchmark_filter='six_faces|^pair_' \
            --benchmark_enable_random_interleaving=true --benchmark_repetitions=5 \
            --benchmark_min_time=0.05 --benchmark_format=json >"$out/$name.json"
    done
    # 26 classes and types: over a million pairs
    WARPSHADOW_TEST_PAIRS=40000 "$root/build/ci/tests/property/cull_test" \
        'peers 35, J48*' >"$out/oracle.txt"
    "$root/build/ci/tests/lab/lab_omni" 'no edge of a cut scene*' >"$out/chord.txt"
    python3 "$folder/collect.py" "$out"
    python3 "$folder/write_page.py"
}

command_help() {
    usage
}

# Arguments --------------------------------------------------------------------------------------

command=
arguments=()
while (($#)); do
    case $1 in
    --no-install) install=no ;;
    -j)
        [[ ${2-} =~ ^[1-9][0-9]*$ ]] || die "-j needs a number of processes"
        jobs=$2
        shift
        ;;
    -h | --help) command=help ;;
    lab | view | bench)
        # The rest belongs to the program.
        command=$1
        shift
        arguments=("$@")
        break
        ;;
    demo | test | nightly | docs | first-light | figures | point-lights | help) command=$1 ;;
    geometry) command=$1 ;;
    *) die "unknown argument $1 (./run.sh help)" ;;
    esac
    shift
done

"command_${command:-help}" "${arguments[@]}"
