/* The program petves: initialise, build from options, run, report; and what it does without a run: tools of the Python
   package, -help, -version. Exit status: 0 finished or stopped, 1 bad input or a file that cannot be written, 2 a step
   failed. */
#include "base/version.h"
#include "scene/scene.h"
#include <glob.h>
#include <libgen.h>
#include <stdlib.h>
#include <unistd.h>

#ifndef PETVES_PYTHON
#define PETVES_PYTHON "/usr/bin/python3"
#endif

static const char usage[] =
    "petves: inextensible vesicles in two-dimensional viscous flow\n"
    "\n"
    "usage: petves run SCENE.opts [-option value ...]       a scene from a file; options behind it win\n"
    "       petves -option value ...                        the same without a file\n"
    "       mpirun -n RANKS petves run SCENE.opts ...       on several ranks\n"
    "       petves plot|movie|report DIR                    pictures of a run's folder\n"
    "       petves compare RUN RUN, petves sweep DIR ...    two runs side by side, a grid of options\n"
    "\n"
    "examples:\n"
    "  petves run runs/default.opts                         an elongated vesicle relaxes; files in out/default\n"
    "  petves run runs/shear.opts -time_end 5 -output_dir out/mine -view\n"
    "  petves plot out/mine\n"
    "\n"
    "  -help options   every option with its default and what is allowed\n"
    "  -help WORD      those with the word in their name, as in -help vesicle\n"
    "  -help all       sets the scene up and adds the options of its solvers, which are PETSc's\n"
    "  -version        version, commit, PETSc, processor\n"
    "\n"
    "Read on: README.md; docs/choosing.md which grid, step and scheme; docs/errors.md what messages mean;\n"
    "runs/default.opts a scene to start from, its neighbours further ones.\n";

static const char help_line[] =
    "Each line: -option, its default, and in brackets what is allowed. Files have the same, an option a line.\n\n";

/* This process' rank before MPI has begun, which mpirun and srun leave in the environment. NULL: it was started alone.
 */
static const char *RankGiven(void) {
  static const char *const names[] = {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK", "SLURM_PROCID"};
  for (size_t k = 0; k < sizeof(names) / sizeof(names[0]); k++)
    if (getenv(names[k])) return getenv(names[k]);
  return NULL;
}

static PetscBool IsFirst(void) {
  const char *const rank = RankGiven();
  return !rank || !atoi(rank) ? PETSC_TRUE : PETSC_FALSE;
}

/* Settings for a process that is started alone. They keep Open MPI from starting a daemon, from looking for a network
   (0.3 s) and from loading what only several ranks use, and hwloc from looking for graphics cards. Variables that the
   environment sets already keep their values. */
static void StartAlone(void) {
  static const char *const names[][2] = {
      {"OMPI_MCA_ess_singleton_isolated", "1"},
      {"OMPI_MCA_pml", "ob1"},
      {"OMPI_MCA_btl", "self"},
      {"OMPI_MCA_mtl", "^psm,psm2,ofi"},
      {"OMPI_MCA_coll", "self,basic,libnbc"},
      {"OMPI_MCA_osc", "^sm,monitoring,rdma,pt2pt,ucx"},
      {"HWLOC_PLUGINS_PATH", "/"},
  };
  if (RankGiven()) return;
  for (size_t k = 0; k < sizeof(names) / sizeof(names[0]); k++) (void)setenv(names[k][0], names[k][1], 0);
}

static PetscBool IsOneOf(const char *word, const char *const list[]) {
  for (; *list; list++)
    if (!strcmp(*list, word)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* -help and -version are answered before MPI begins; -help all is left to the run, by its name. -1: neither is there.
 */
static int Answer(int n, char **word) {
  static const char *const help[] = {"-help", "--help", "-h", NULL}, *const version[] = {"-version", "--version", NULL};
  static char plain[] = "-help"; /* without a value, which PETSc 3.18 would read after it has freed it */
  char line[PETVES_MAX_MESSAGE];
  for (int k = 0; k < n; k++) {
    const char *topic = k + 1 < n && word[k + 1][0] != '-' ? word[k + 1] : NULL;
    if (IsOneOf(word[k], version)) {
      if (IsFirst() && !PetvesVersion(line, sizeof(line))) printf("%s\n", line);
      return 0;
    }
    if (!IsOneOf(word[k], help)) continue;
    if (topic && !strcmp(topic, "all")) {
      word[k] = word[k + 1] = plain;
      return -1;
    }
    if (!IsFirst()) return 0;
    if (!topic || !strcmp(topic, "options")) printf("%s", topic ? help_line : usage);
    if (!topic || SceneHelp(stdout, strcmp(topic, "options") ? topic : NULL)) return 0;
    fprintf(stderr, "petves: error: -help %.100s: in no option's name; allowed: options, all, or part of a name\n",
            topic);
    return 1;
  }
  return -1;
}

/* Where Python finds the package: that of the source tree or of the prefix, whichever this program is in. */
static void FindPackage(void) {
  static const char *const places[] = {"../python", "../lib/python3*/dist-packages"};
  char path[PETSC_MAX_PATH_LEN] = "", pattern[PETSC_MAX_PATH_LEN + 64];
  const char *const before = getenv("PYTHONPATH");
  glob_t found;
  if (readlink("/proc/self/exe", path, sizeof(path) - 1) < 0) return;
  if (!strcmp(basename(path), "petves")) (void)setenv("PETVES", path, 0);
  (void)dirname(path);
  for (size_t k = 0; k < sizeof(places) / sizeof(places[0]); k++) {
    (void)snprintf(pattern, sizeof(pattern), "%s/%s/petves/__main__.py", path, places[k]);
    if (glob(pattern, 0, NULL, &found)) continue;
    found.gl_pathv[0][strlen(found.gl_pathv[0]) - strlen("/petves/__main__.py")] = 0;
    (void)snprintf(pattern, sizeof(pattern), "%s%s%s", found.gl_pathv[0], before && *before ? ":" : "",
                   before ? before : "");
    (void)setenv("PYTHONPATH", pattern, 1);
    globfree(&found);
    return;
  }
}

/* petves plot ...: the Python package's. Does not return, but where there is no Python. */
static int StartTool(int argc, char **argv) {
  char **word = (char **)calloc((size_t)argc + 3, sizeof(*word));
  if (!word) return 1;
  if (!IsFirst()) return 0;
  FindPackage();
  (void)setenv("PYTHONSAFEPATH", "1", 1); /* the folder where one stands may be anybody's: no module from there */
  word[0] = strdup(PETVES_PYTHON);
  word[1] = strdup("-m");
  word[2] = strdup("petves");
  for (int k = 1; k < argc; k++) word[k + 2] = argv[k];
  (void)execv(word[0], word);
  fprintf(stderr, "petves: error: %s: %s cannot be started; allowed: with Debian's python3 and its packages\n", argv[1],
          PETVES_PYTHON);
  return 1;
}

static PetscErrorCode Run(PetscBool *good) {
  Simulation simulation = NULL;
  PetscErrorCode error;
  PetscBool only_help;
  PetscFunctionBeginUser;
  PetscCall(PetvesCatchSignals());
  PetscCall(PetscOptionsHasHelp(NULL, &only_help));
  error = SimulationCreate(PETSC_COMM_WORLD, &simulation);
  if (!error && !only_help) error = SimulationRun(simulation, good);
  /* a mistake or a file that cannot be written stops every rank; any other error may be one rank's, and others wait */
  if (!error || error == PETSC_ERR_USER_INPUT) PetscCall(SimulationDestroy(&simulation));
  PetscCall(error);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static int RunOrUsage(int argc, char **argv) {
  const char *const given = getenv("PETSC_OPTIONS");
  const PetscBool asked = argc > 1 || (given && given[strspn(given, " \t\n")]) ? PETSC_TRUE : PETSC_FALSE;
  PetscBool good = PETSC_TRUE;
  PetscErrorCode error;
  StartAlone();
  error = PetvesInitialize(&argc, &argv);
  if (error) return 1;
  if (asked) error = Run(&good);
  if (!asked) (void)PetscFPrintf(PETSC_COMM_WORLD, stderr, "%s", usage);
  if (error && error != PETSC_ERR_USER_INPUT) PetvesEndTogether(PETSC_COMM_WORLD, NULL);
  if (PetvesFinalize() || error || !asked) return 1;
  return good ? 0 : 2;
}

int PetvesMain(int argc, char **argv) {
  static const char *const tools[] = {"plot",  "movie",   "watch",  "report", "compare",
                                      "sweep", "numbers", "scenes", NULL};
  static char options_file[] = "-options_file";
  int status;
  if (argc > 1 && IsOneOf(argv[1], tools)) return StartTool(argc, argv);
  if (argc > 1 && !strcmp(argv[1], "run")) { /* petves run FILE, petves run -option */
    const PetscBool file = argc > 2 && argv[2][0] != '-' ? PETSC_TRUE : PETSC_FALSE;
    argv[1] = file ? options_file : argv[0];
    if (!file) argc--, argv++;
  }
  status = Answer(argc - 1, argv + 1);
  return status < 0 ? RunOrUsage(argc, argv) : status;
}
