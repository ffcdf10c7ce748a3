"""Write petves.1, the manual page, and petves.bash, completion for bash, from what ``petves -help`` prints.

``python3 python/make_manual.py bin/petves FOLDER``; ``make manual`` calls it.
"""

from __future__ import annotations

import itertools
import subprocess
import sys
from pathlib import Path

from check_options import Option, described

TOOLS = "run plot movie watch report compare sweep numbers scenes"
WORDS = "-help -version -options_file -log_view"
FILES = "-options_file -restart -vesicle_file -obstacle_file"
FOLDERS = "-output_dir"


def printed(binary: str, *words: str) -> str:
    """Return what petves prints."""
    return subprocess.run([binary, *words], capture_output=True, text=True, check=True).stdout


def roff(text: str) -> str:
    """Return text as troff takes it: no line begins with a dot or a quote, dashes are dashes."""
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return "\n".join(f"\\&{line}" if line[:1] in (".", "'") else line for line in text.splitlines())


def manual(options: list[Option], usage: str, version: str) -> str:
    """Return the manual page."""
    name, _, rest = usage.partition("\n\n")
    lines = [f'.TH PETVES 1 "" "{version}"', ".SH NAME", roff(name.replace(": ", " - ", 1))]
    lines += [".SH SYNOPSIS", ".nf", roff(rest), ".fi", ".SH OPTIONS"]
    lines += ["On the command line, or one a line in a file. In brackets: the default; what is allowed."]
    for group, members in itertools.groupby(options, lambda option: option.group):
        lines.append(f'.SS "{group}"')
        for option in members:
            limits = "; ".join(part for part in (option.default, option.allowed) if part)
            lines += [".TP", f".B {roff(option.name)}", *([roff(f"[{limits}]")] if limits else []), roff(option.what)]
    lines += [".SH EXIT STATUS", ".TP", "0", "Finished, steady, or stopped by a signal or \\-time_wall_limit."]
    lines += [".TP", "1", "Bad input, or a file that could not be written; one line says which.", ".TP", "2"]
    lines += ["A step could not be taken; the last good state is in checkpoint.h5.", ".SH SEE ALSO", ".BR mpirun (1)"]
    return "\n".join(lines) + "\n"


def completion(options: list[Option]) -> str:
    """Return bash completion: tools, options, and the words that an option may have."""
    choices = [
        f"    {option.name}) COMPREPLY=($(compgen -W '{option.allowed.replace('|', ' ')}' -- \"$word\")); return ;;"
        for option in options
        if "|" in option.allowed
    ]
    names = " ".join(option.name for option in options)
    return "\n".join(
        [
            "# bash completion of petves",
            "_petves() {",
            '  local word="${COMP_WORDS[COMP_CWORD]}" before="${COMP_WORDS[COMP_CWORD-1]}"',
            '  case "$before" in',
            f'    {"|".join(FILES.split())}) COMPREPLY=($(compgen -f -- "$word")); return ;;',
            f'    {FOLDERS}|plot|movie|watch|report|compare|sweep) COMPREPLY=($(compgen -d -- "$word")); return ;;',
            '    run) COMPREPLY=($(compgen -f -- "$word")); return ;;',
            "    -help) COMPREPLY=($(compgen -W 'options all' -- \"$word\")); return ;;",
            *choices,
            "  esac",
            f"  local all='{names} {WORDS}'",
            f"  ((COMP_CWORD == 1)) && all='{TOOLS} help '$all",
            '  COMPREPLY=($(compgen -W "$all" -- "$word"))',
            "}",
            "complete -o filenames -F _petves petves",
            "",
        ]
    )


def main() -> None:
    """Write both files."""
    binary, folder = sys.argv[1], Path(sys.argv[2])
    options = described(binary)
    version = printed(binary, "-version").split(",")[0]
    (folder / "petves.1").write_text(manual(options, printed(binary, "-help"), version))
    (folder / "petves.bash").write_text(completion(options))


if __name__ == "__main__":
    main()
