# Completion of sphgeo for bash: commands, options, decks, and the names that `sphgeo show` knows.
# Installed where bash-completion looks; or: source share/completion/sphgeo.bash

_sphgeo() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} command=${COMP_WORDS[1]}
  local commands="run check relax export study compare report list show reference schema bench"
  local options=""
  COMPREPLY=()

  if ((COMP_CWORD == 1)); then
    mapfile -t COMPREPLY < <(compgen -W "$commands --help --version -h" -- "$word")
    return
  fi
  case $command in
    run) options="--help -h --set --output -o --threads --overwrite --resume --max-hours --max-steps --max-acoustic-steps --verify --no-report --quiet -q" ;;
    check) options="--help -h --set --explain --json --preview --no-calibrate --threads" ;;
    relax) options="--help -h --set --output -o --threads --overwrite --verify --quiet -q" ;;
    export) options="--help -h --set --output -o --spacing --overwrite" ;;
    study) options="--help -h --set --vary --combine --output -o --jobs --threads --max-hours --quiet -q" ;;
    compare) options="--help -h --tolerances --update --json --all" ;;
    bench) options="--help -h --effects --json --scene --size --precision --seconds --repeats" ;;
    report) options="--help -h --output -o" ;;
    list | show | reference | schema) options="--help -h" ;;
    *) return ;;
  esac

  case $before in
    -o | --output)
      if [[ $command == export ]]; then mapfile -t COMPREPLY < <(compgen -f -X '!*.stl' -- "$word"; compgen -d -- "$word")
      elif [[ $command == report ]]; then mapfile -t COMPREPLY < <(compgen -f -X '!*.html' -- "$word"; compgen -d -- "$word")
      else mapfile -t COMPREPLY < <(compgen -d -- "$word"); fi
      return ;;
    --preview)
      mapfile -t COMPREPLY < <(compgen -f -X '!*.png' -- "$word"; compgen -d -- "$word")
      return ;;
    --precision)
      mapfile -t COMPREPLY < <(compgen -W "single double both" -- "$word")
      return ;;
    --scene)
      mapfile -t COMPREPLY < <(compgen -W "water_block_h1.3 water_block_h1.8 dam_break" -- "$word")
      return ;;
    --tolerances)
      mapfile -t COMPREPLY < <(compgen -f -- "$word")
      return ;;
    --set | --spacing | --vary | --jobs | --threads | --max-hours | --max-steps | --max-acoustic-steps | --size | --seconds | --repeats)
      return ;;
  esac

  if [[ $word == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word")
  elif [[ $command == show ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$("${COMP_WORDS[0]}" list 2>/dev/null | sed -n 's/^  \([^ ]*\) .*/\1/p')" -- "$word")
  elif [[ $command == report ]]; then
    mapfile -t COMPREPLY < <(compgen -d -- "$word")
  elif [[ $command == run || $command == check || $command == relax || $command == export || $command == study ]]; then
    # Decks, and folders on the way to them.
    mapfile -t COMPREPLY < <(compgen -f -X '!*.yaml' -- "$word"; compgen -d -S / -- "$word")
    compopt -o nospace 2>/dev/null
    [[ ${#COMPREPLY[@]} == 1 && ${COMPREPLY[0]} == *.yaml ]] && compopt +o nospace 2>/dev/null
  elif [[ $command == compare ]]; then
    mapfile -t COMPREPLY < <(compgen -f -- "$word")
  fi
  return 0
}

complete -o filenames -F _sphgeo sphgeo
