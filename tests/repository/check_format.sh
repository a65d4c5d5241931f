#!/bin/sh
# Fails if clang-format ($1) would change a C++ file; prints the command that mends it.
set -eu

cpp_files() {
    for folder in include gl lab samples tools tests bench docs; do
        if [ -d "$folder" ]; then
            find "$folder" -name '*.hpp' -print0 -o -name '*.cpp' -print0
        fi
    done
}

if ! cpp_files | xargs -0 "$1" --dry-run -Werror; then
    echo "mend it with: git ls-files '*.hpp' '*.cpp' | xargs clang-format -i"
    exit 1
fi
