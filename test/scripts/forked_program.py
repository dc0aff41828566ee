"""Runs a program of Python in a fork of the test: what it imports is read once for all runs, and each run
has a process, a folder and an exit status of its own, as a user's has."""
import os
import subprocess
import sys
import tempfile
import traceback
import warnings


def run_forked(main, words, folder, packages, imported):
    """What `main(words)` prints and returns, in a folder; `packages` is the folder of its modules.

    The modules of the list `imported` are there already, whatever the program needs of them.
    """
    if packages not in sys.path:
        sys.path.insert(0, packages)
    for name in imported:
        __import__(name)
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        sys.stdout.flush()
        sys.stderr.flush()
        child = os.fork()
        if child == 0:
            _be_the_program(main, words, folder, out, err)
        status = os.WEXITSTATUS(os.waitpid(child, 0)[1])
        texts = []
        for file in (out, err):
            file.seek(0)
            texts.append(file.read().decode('utf-8'))
    return subprocess.CompletedProcess(words, status, *texts)


def _be_the_program(main, words, folder, out, err):
    status = 1
    try:
        os.dup2(out.fileno(), 1)
        os.dup2(err.fileno(), 2)
        sys.stdout = open(1, 'w', encoding='utf-8', closefd=False)
        sys.stderr = open(2, 'w', encoding='utf-8', closefd=False)
        os.chdir(folder)
        # Those that a test turns on are not a program's.
        warnings.filterwarnings('ignore', category=ResourceWarning)
        warnings.filterwarnings('ignore', category=DeprecationWarning)
        status = main(words) or 0
    except SystemExit as end:
        status = end.code if isinstance(end.code, int) else 1
    except BaseException:  # as Python itself does
        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)
