/* The program petves: initialise, build from options, run, report; and what it does without a run: tools of the Python
   package, -help, -version. Exit status: 0 finished or stopped, 1 bad input or a file that cannot be written, 2 a step
   failed. */
#include "base/version.h"
#include "scene/scene.h"
#include <glob.h>
#include <libgen.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#ifndef PETVES_PYTHON
#define PETVES_PYTHON "/usr/bin/python3"
#endif

static const char usage[] =
    "petves: vesicles and capsules in viscous flow, in the plane, and vesicles in three dimensions\n"
    "\n"
    "usage: petves run SCENE [-option value ...]            a scene: a file, or a name of petves scenes\n"
    "       petves -option value ...                        the same without a file\n"
    "       mpirun -n RANKS petves run SCENE ...            on several ranks\n"
    "       petves plot|movie|watch|report DIR              pictures of a run's folder\n"
    "       petves compare RUN RUN, petves sweep DIR ...    two runs side by side, a grid of options\n"
    "       petves scenes, petves numbers ...               scenes that come with petves; options from SI units\n"
    "\n"
    "Options of a run have one dash, -time_end 5, and win over the scene's; those of the tools two, --width 3.4.\n"
    "\n"
    "  petves run shear -time_end 5 -output_dir out/mine    a vesicle in shear, into the folder out/mine\n"
    "  petves plot out/mine                                 draws it\n"
    "\n"
    "  -help options   every option with its default and what is allowed; -help and help are the same\n"
    "  -help WORD      those with the word in their name or help, as in -help channel\n"
    "  -help TOOL      a tool and its options, as in -help plot\n"
    "  -help all       sets the scene up and adds the options of its solvers, which are PETSc's\n"
    "  -version        version, commit, PETSc, processor\n"
    "\n"
    "Read on: README.md; docs/choosing.md which grid, step and scheme; docs/errors.md what messages mean\n"
    "(after make install in share/doc/petves).\n";

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
  return !rank || !atoi(rank);
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

/* What the Python package does. */
static const char *const tools[] = {"plot", "movie", "watch", "report", "compare", "sweep", "numbers", "scenes", NULL};

static PetscBool IsOneOf(const char *word, const char *const list[]) {
  for (; *list; list++)
    if (!strcmp(*list, word)) return PETSC_TRUE;
  return PETSC_FALSE;
}

/* The path of a file in one of the places, which count from the folder of this program. FALSE: it is in none. */
static PetscBool FindBeside(const char *const places[], const char *file, char path[PETSC_MAX_PATH_LEN]) {
  char self[PETSC_MAX_PATH_LEN] = "", pattern[2 * PETSC_MAX_PATH_LEN];
  glob_t found;
  if (readlink("/proc/self/exe", self, sizeof(self) - 1) < 0) return PETSC_FALSE;
  (void)dirname(self);
  for (; *places; places++) {
    (void)snprintf(pattern, sizeof(pattern), "%s/%s/%s", self, *places, file);
    if (glob(pattern, 0, NULL, &found)) continue;
    (void)snprintf(path, PETSC_MAX_PATH_LEN, "%s", found.gl_pathv[0]);
    globfree(&found);
    return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

/* Where Python finds the package: that of the source tree or of the prefix, whichever this program is in. */
static void FindPackage(void) {
  static const char *const places[] = {"../python", "../lib/python3*/site-packages", "../lib/python3*/dist-packages",
                                       NULL};
  static const char file[] = "petves/__main__.py";
  char path[PETSC_MAX_PATH_LEN] = "", paths[2 * PETSC_MAX_PATH_LEN];
  const char *const before = getenv("PYTHONPATH");
  if (readlink("/proc/self/exe", path, sizeof(path) - 1) < 0) return;
  if (!strcmp(basename(path), "petves")) (void)setenv("PETVES", path, 0);
  if (!FindBeside(places, file, path)) return;
  path[strlen(path) - strlen(file) - 1] = 0;
  (void)snprintf(paths, sizeof(paths), "%s%s%s", path, before && *before ? ":" : "", before ? before : "");
  (void)setenv("PYTHONPATH", paths, 1);
}

/* The file of a scene: the word, or, where that is no file, the scene of this name of the source tree or the prefix. */
static char *SceneFile(char *word) {
  static const char *const places[] = {"../runs", "../share/petves/runs", NULL};
  static char path[PETSC_MAX_PATH_LEN];
  char file[PETSC_MAX_PATH_LEN];
  struct stat status;
  if ((!stat(word, &status) && !S_ISDIR(status.st_mode)) || strpbrk(word, "*?[")) return word;
  (void)snprintf(file, sizeof(file), "%s.opts", word);
  return FindBeside(places, file, path) ? path : word;
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

/* -help and -version are answered before MPI begins; -help all is left to the run, by its name. -1: neither is there.
 */
static int Answer(int n, char **word) {
  static const char *const help[] = {"-help", "--help", "-h", NULL}, *const version[] = {"-version", "--version", NULL};
  static char tool_help[] = "--help";
  static char plain[] = "-help"; /* without a value, which PETSc 3.18 would read after it has freed it */
  char line[PETVES_MAX_MESSAGE];
  for (int k = 0; k < n; k++) {
    const char *topic = k + 1 < n && word[k + 1][0] != '-' ? word[k + 1] : NULL;
    if (IsOneOf(word[k], version)) {
      if (IsFirst() && !PetvesVersion(line, sizeof(line))) printf("%s\n", line);
      return 0;
    }
    if (!IsOneOf(word[k], help)) continue;
    if (topic && IsOneOf(topic, tools)) return StartTool(3, (char *[]){NULL, word[k + 1], tool_help});
    if (topic && !strcmp(topic, "all")) {
      word[k] = word[k + 1] = plain;
      return -1;
    }
    if (!IsFirst()) return 0;
    if (!topic || !strcmp(topic, "options")) printf("%s", topic ? help_line : usage);
    if (!topic || SceneHelp(stdout, strcmp(topic, "options") ? topic : NULL)) return 0;
    fprintf(stderr,
            "petves: error: -help %.100s: in no option's name or help; allowed: options, all, a tool, or a word\n",
            topic);
    return 1;
  }
  return -1;
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
  const PetscBool asked = argc > 1 || (given && given[strspn(given, " \t\n")]);
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
  static char options_file[] = "-options_file", help[] = "-help";
  const PetscBool run = argc > 1 && !strcmp(argv[1], "run");
  char *scene = NULL, **words;
  int status, n = 1;
  if (argc > 1 && !strcmp(argv[1], "help")) argv[1] = help;
  if (argc > 1 && IsOneOf(argv[1], tools)) return StartTool(argc, argv);
  if (run) argc--, argv++; /* petves run FILE is petves FILE, petves run -option is petves -option */
  if (argc > 1 && argv[1][0] != '-') scene = SceneFile(argv[1]);
  if (scene && !run && access(scene, F_OK)) return StartTool(argc, argv); /* no scene: names the command that is near */
  words = (char **)calloc((size_t)argc + 2, sizeof(*words));
  if (!words) return 1;
  words[0] = argv[0];
  if (scene) words[n++] = options_file;
  if (scene) words[n++] = scene;
  for (int k = scene ? 2 : 1; k < argc; k++) words[n++] = argv[k];
  status = Answer(n - 1, words + 1);
  if (status < 0) status = RunOrUsage(n, words);
  free(words);
  return status;
}
