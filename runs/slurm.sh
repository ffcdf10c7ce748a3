#!/bin/bash
# A run longer than a job may last: each job goes on where the one before it stopped, and hands on to the next.
# sbatch runs/slurm.sh runs/two_vesicles.opts [FOLDER]      the folder out/two_vesicles where none is given
#SBATCH --job-name=petves
#SBATCH --ntasks=4
#SBATCH --time=01:00:00
#SBATCH --signal=B:USR1@120        # two minutes before the end, to this script
#SBATCH --open-mode=append
options=${1:?an options file}
folder=${2:-out/$(basename "$options" .opts)}

restart() { [ -e "$folder/checkpoint.h5" ] && echo "-restart $folder/checkpoint.h5"; }

# shellcheck disable=SC2046 # two words or none
mpirun bin/petves -options_file "$options" -output_dir "$folder" $(restart) -time_wall_limit 3400 &
run=$!
trap 'kill -USR1 $run' USR1          # mpirun hands it on to the ranks
wait $run || wait $run               # the first wait ends when the signal comes
status=$?

if [ $status = 0 ] && grep -q '"reason": "stopped"' "$folder/summary.json"; then
  sbatch "$0" "$options" "$folder"
fi
exit $status
