/* Parts of the output that no small run reaches: rows of many vesicles, texts longer than an HDF5 attribute, and the
   places of frames. */
#include "facts.h"
#include "output/h5series.h"
#include "output/record.h"
#include <stdlib.h>

/* A text comes back on every rank, at lengths around those of the attributes that it is cut into. */
static void CheckTexts(void) {
  const size_t lengths[] = {0, 1, 31999, 32000, 32001, 64000, 200000};
  const int n = sizeof(lengths) / sizeof(lengths[0]);
  const char *path = TestScratch("texts.h5");
  char *text, *back;
  PetscBool failed;
  H5File file;
  TestCall(PetscMalloc1(lengths[n - 1] + 1, &text));
  for (int pass = 0; pass < 2; pass++) {
    TestCall(H5FileOpen(PETSC_COMM_WORLD, path, pass ? H5_READ : H5_NEW, &file));
    for (int k = 0; k < n; k++) {
      for (size_t i = 0; i < lengths[k]; i++) text[i] = (char)('a' + (i * i + 7 * i + (size_t)k) % 26);
      text[lengths[k]] = 0;
      const char *name = TestText("text%d", k);
      if (!pass) {
        H5PutText(&file, name, text);
        continue;
      }
      TestCall(H5GetText(&file, name, &back));
      CHECK(!strcmp(back, text), "a text of %zu characters", lengths[k]);
      TestCall(PetscFree(back));
    }
    TestCall(H5FileFailed(&file, &failed));
    CHECK(!failed, "texts %s", pass ? "read" : "written");
    H5FileClose(&file);
  }
  TestCall(PetscFree(text));
}

/* A row has room for the longest numbers of all its vesicles, and comes back from its text. Of up to 40 vesicles it has
   the columns of each. */
static void CheckRows(PetscInt vesicles) {
  static const RecordColumn column[] = {{"step", RECORD_RUN},
                                        {"area", RECORD_TOTAL},
                                        {"wall", RECORD_RUN},
                                        {"contact", RECORD_PAIRS},
                                        {"gap", RECORD_APART}};
  static const char extra[][RECORD_NAME] = {"flux", "force"};
  const RecordSetting setting = {vesicles, 5, 2, column, extra};
  const PetscInt columns = 7 + (vesicles > 1 && vesicles <= 40 ? 2 * vesicles : 0);
  char *text;
  size_t used = 0;
  PetscInt commas = 0;
  Record record;
  TestAbout("%d vesicles", (int)vesicles);
  TestCall(RecordCreate(&setting, &record));
  for (const char *c = record.header; *c; c++) commas += *c == ',';
  CHECK(commas == columns - 1, "%d columns", (int)columns);
  const char *last = columns > 7 ? TestText("gap_%d,flux,force", (int)vesicles) : "contact,gap,flux,force";
  CHECK(!strcmp(record.header + strlen(record.header) - strlen(last), last), "the last columns");
  TestCall(PetscMalloc1(32 * columns, &text));
  for (PetscInt c = 0; c < columns; c++)
    used += (size_t)snprintf(text + used, 32, "%s%.17g", c ? "," : "", -1.2345678901234567e-300 * (c + 1));
  RecordParse(&record, text);
  CHECK(!strcmp(record.text, text), "a row of %zu characters", used);
  CHECK(RecordNumber(&record, "area") == -1.2345678901234567e-300 * 2, "its numbers");
  TestCall(PetscFree(text));
  TestCall(RecordDestroy(&record));
}

/* What the columns of all vesicles are of theirs. */
static void CheckCombined(void) {
  static const struct {
    RecordKind kind;
    PetscReal all;
  } fact[] = {{RECORD_RUN, 7},   {RECORD_PAIRS, -2}, {RECORD_APART, 7},  {RECORD_TOTAL, -2}, {RECORD_WORST, -4},
              {RECORD_MEAN, -1}, {RECORD_FIRST, 2},  {RECORD_LEAST, -4}, {RECORD_LARGEST, 2}};
  const int kinds = sizeof(fact) / sizeof(fact[0]);
  RecordColumn column[9] = {{"a", RECORD_RUN}};
  const RecordSetting setting = {.vesicles = 2, .columns = kinds, .column = column};
  Record record;
  for (int c = 0; c < kinds; c++) column[c].kind = fact[c].kind;
  TestCall(RecordCreate(&setting, &record));
  for (int c = 0; c < kinds; c++) {
    record.last[c] = 7;
    record.each[c] = 2;
    record.each[kinds + c] = -4;
  }
  RecordCombine(&record);
  for (int c = 0; c < kinds; c++)
    CHECK(record.last[c] == fact[c].all, "kind %d of 2 and -4: %g", (int)fact[c].kind, record.last[c]);
  TestCall(RecordDestroy(&record));
}

/* The place of a frame is HDF5's own answer; asked after many frames, and of a file that was opened again. */
static void CheckPlaces(void) {
  const PetscInt frames = 300, size[2] = {5, 7}, ask[] = {0, 1, 63, 64, 150, 299};
  const char *path = TestScratch("places.h5");
  PetscReal values[35], *read = values;
  H5File file;
  TestCall(H5FileOpen(PETSC_COMM_WORLD, path, H5_NEW, &file));
  H5CreateSeries(&file, "/a/one", PETSC_FALSE, 2, size);
  H5CreateSeries(&file, "/a/two", PETSC_FALSE, 1, size);
  for (PetscInt t = 0; t < frames; t++) {
    for (int k = 0; k < 35; k++) values[k] = t + k / 64.0;
    H5Transfer(&file, PETSC_TRUE, "/a/one", t, 35, values);
    H5Transfer(&file, PETSC_TRUE, "/a/two", t, 5, values);
    H5FileFlush(&file);
  }
  for (int pass = 0; pass < 2; pass++) {
    for (size_t k = 0; k < sizeof(ask) / sizeof(ask[0]); k++) {
      const hsize_t start[2] = {(hsize_t)ask[k], 0};
      haddr_t place = HADDR_UNDEF;
      hsize_t bytes;
      unsigned filters;
      PetscBool same = PETSC_TRUE;
      if (!file.rank) {
        const hid_t set = H5Dopen2(file.id, "/a/two", H5P_DEFAULT);
        (void)H5Dget_chunk_info_by_coord(set, start, &filters, &place, &bytes);
        (void)H5Dclose(set);
        same = place != HADDR_UNDEF && H5EntryPlace(&file, "/a/two", ask[k]) == place;
      }
      CHECK(same, "frame %d of %d lies where HDF5 says", (int)ask[k], (int)frames);
      TestCall(H5ReadArray(&file, "/a/one", ask[k], 35, read));
      CHECK(read[34] == ask[k] + 34 / 64.0, "and frame %d of the other series is as written", (int)ask[k]);
    }
    H5FileClose(&file);
    if (!pass) TestCall(H5FileOpen(PETSC_COMM_WORLD, path, H5_READ, &file));
  }
}

void Facts(void) {
  CheckTexts();
  CheckRows(1);
  CheckRows(40);
  CheckRows(5000);
  TestAbout("records");
  CheckCombined();
  TestAbout("frames");
  CheckPlaces();
}
