"""The scripts that teach the shells to ask."""

from __future__ import annotations

import sys

from stackloft.model.errors import UsageError
from stackloft.registry.find import nearest

BASH = r"""# stackloft completion for bash; in ~/.bashrc:  eval "$(stackloft completion bash)"
_stackloft_complete() {
    local -a told
    local line
    mapfile -t told < <(
        _STACKLOFT_COMPLETE=bash _STACKLOFT_LINE="${COMP_LINE:0:COMP_POINT}" \
        _STACKLOFT_BREAKS="$COMP_WORDBREAKS" "$1" 2>/dev/null
    )
    COMPREPLY=()
    if [[ ${told[0]} == files ]]; then
        compopt -o default
        return
    fi
    for line in "${told[@]:1}"; do
        [[ $line == *$'\topen' ]] && compopt -o nospace
        COMPREPLY+=("${line%%$'\t'*}")
    done
}
complete -F _stackloft_complete stackloft
"""

ZSH = r"""#compdef stackloft
# stackloft completion for zsh; in ~/.zshrc:  eval "$(stackloft completion zsh)"
_stackloft_complete() {
    local -a told closed open
    local line word about
    line="${words[1,CURRENT-1]} $PREFIX"
    told=("${(@f)$(_STACKLOFT_COMPLETE=zsh _STACKLOFT_LINE=$line $words[1] 2>/dev/null)}")
    if [[ $told[1] == files ]]; then
        _files
        return
    fi
    for line in "${(@)told[2,-1]}"; do
        word=${line%%$'\t'*}
        about=${${line#*$'\t'}%$'\t'open}
        if [[ $line == *$'\topen' ]]; then
            open+=("${word//:/\\:}:$about")
        else
            closed+=("${word//:/\\:}:$about")
        fi
    done
    (( $#closed )) && _describe -t stackloft stackloft closed
    (( $#open )) && _describe -t stackloft stackloft open -S ''
}
(( $+functions[compdef] )) || { autoload -Uz compinit && compinit }
if [[ $funcstack[1] == _stackloft ]]; then
    _stackloft_complete "$@"
else
    compdef _stackloft_complete stackloft
fi
"""

FISH = r"""# stackloft completion for fish:
#     stackloft completion fish > ~/.config/fish/completions/stackloft.fish
function _stackloft_complete
    set -l line (commandline -cp | string collect)
    set -l told (_STACKLOFT_COMPLETE=fish _STACKLOFT_LINE=$line stackloft 2>/dev/null)
    if test "$told[1]" = files
        __fish_complete_path (commandline -ct)
    else
        for line in $told[2..-1]
            string replace -r '\topen$' '' -- $line
        end
    end
end
complete --command stackloft --no-files --arguments '(_stackloft_complete)'
"""

SCRIPTS = {"bash": BASH, "zsh": ZSH, "fish": FISH}


def show(shell: str) -> None:
    """Print the script of a shell.

    Raises
    ------
    UsageError
        Another shell.
    """
    if shell not in SCRIPTS:
        raise UsageError(f"no completion for {shell!r}", where="SHELL", fix=nearest(shell, list(SCRIPTS)))
    sys.stdout.write(SCRIPTS[shell])
