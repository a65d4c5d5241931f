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
  measure PAGE  measure again what docs/PAGE shows, and write it (without PAGE: lists them)
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

# measure PAGE: sources docs/PAGE/measure.sh, with $folder for what is kept and $out for the rest.
command_measure() {
    local page=${1-} pages
    pages=$(cd "$root/docs" && printf '%s\n' */measure.sh | sed 's|/measure.sh||')
    if [[ -z $page ]]; then
        printf '%s\n' "$pages"
        return
    fi
    grep -qx -- "$page" <<<"$pages" || die "measure: no page $page (there are: ${pages//$'\n'/, })"
    local folder=$root/docs/$page out=$root/build/measure/$page
    rm -rf "$out"
    mkdir -p "$out"
    # shellcheck source=/dev/null
    source "$folder/measure.sh"
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
    lab | view | bench | measure)
        # The rest belongs to the program.
        command=$1
        shift
        arguments=("$@")
        break
        ;;
    demo | test | nightly | docs | help) command=$1 ;;
    *) die "unknown argument $1 (./run.sh help)" ;;
    esac
    shift
done

"command_${command:-help}" "${arguments[@]}"
