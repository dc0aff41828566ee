"""From files to what was found in them: the steps of identify.py in their order."""
import os
import tempfile

import numpy as np

from vwd_loads.progress import Progress

from . import bodies
from .base import BaseParameters
from .files import Description, check_link, found_scene, payload_entry, read_scene, scene_to_fit
from .files import unloaded as without_payload
from .files import write_scene
from .filtering import chosen_cutoff
from .outcome import Outcome
from .problem import Parameter, check_length, filtered_pieces
from .recording import Regressor, Tool, find_tool
from .refusal import Refusal
from .report import write_report
from .solver import Block, Solver, condition_of
from .wanted import Wanted

RESTS = 1e-3  # rad or m: a joint that stays within this does not move
LARGE = 0.1  # of an effort's rms: a deviation that a joint's term would have to make up to count as unknown
NO_EFFORTS = ('no column effort.<joint>', 'has no efforts that were measured')  # ends what the tool says
RANDOM_STATES = 150  # for the base parameters: rows of every effort, for at most some hundred unknowns
PAYLOAD_RADIUS = 0.1  # m: radius of gyration of a payload of which the motion does not tell it
VAGUE = 1e-4  # weight of what is thought of a body of which nothing is known


class Recording:
    """A regressor with measured efforts, and which of its rows are fitted."""

    def __init__(self, regressor, measured, keep, loaded=True):
        self.regressor, self.measured, self.keep, self.loaded = regressor, measured, keep, loaded


class Study:
    def __init__(self, arguments, options, program):
        self.arguments = arguments
        self.wanted = Wanted(arguments.fit)
        self.progress = Progress(quiet=True)
        self.tool = Tool(find_tool(arguments.tool, program), options, print if arguments.verbose else None)
        self.description = Description(arguments.urdf)
        self.scene = read_scene(arguments.scene)
        self.wanted.check(self.scene, arguments.unloaded, arguments.masses_known)
        if arguments.measured_topic and not arguments.measured:
            raise Refusal('--measured-topic: is the topic in the file of --measured, which is not given')
        if arguments.coulomb_velocity <= 0:
            raise Refusal('--coulomb-velocity: is not a positive number')
        if self.wanted.payload:
            check_link(self.wanted.payload, self.description)
        self.fit_scene = scene_to_fit(self.scene, self.description.moving_joints(), arguments.coulomb_velocity,
                                      self.wanted.payload)
        self.folder = None

    def run(self):
        with tempfile.TemporaryDirectory(prefix='identify_') as folder:
            self.folder = folder
            try:
                outcome = self._outcome()
                os.makedirs(self.arguments.output, exist_ok=True)
                self._write(outcome)
                self._judge(outcome)
                self.progress.clear()
                write_report(self.arguments.output, outcome)
            finally:
                self.progress.clear()

    # --- reading

    def _regressor(self, name, scene, motion, parameters, urdf=None, recorded=True):
        path = os.path.join(self.folder, name)
        write_scene(path + '.yaml', scene, [])
        self.progress.stage('reading and computing ' + ' '.join(motion))
        self.tool.regressor(urdf or self.arguments.urdf, path + '.yaml', motion, path, parameters, recorded)
        return Regressor(path)

    def _asked(self):
        asked = ['joints'] + (['links'] if self.wanted.base else [])
        return asked + ([self.wanted.payload] if self.wanted.payload else [])

    def _measured(self, regressor, motion, own=False):
        efforts = [] if own or not self.arguments.measured else ['--measured', self.arguments.measured]
        if efforts and self.arguments.measured_topic:
            efforts += ['--measured-topic', self.arguments.measured_topic]
        path = os.path.join(self.folder, 'static.yaml')
        write_scene(path, dict(self.fit_scene, motion='static'), [])
        try:
            return self.tool.measured(self.arguments.urdf, path, motion, efforts or ['--residuals'], regressor)
        except Refusal as problem:
            if efforts or not str(problem).endswith(NO_EFFORTS):
                raise
            raise Refusal('%s: has no measured efforts: neither columns effort.<joint> nor efforts of joint states%s'
                          % (' '.join(motion), '' if own else ', and no --measured FILE has them')) from None

    def _recordings(self):
        arguments = self.arguments
        regressor = self._regressor('main', self.fit_scene, arguments.motion, self._asked())
        times = regressor.times
        until = arguments.fit_until
        if until is not None and not 0 < until:
            raise Refusal('--fit-until: is not a positive number')
        if until is None:
            until = np.inf if arguments.validation else (times[-1] - times[0]) * 2 / 3
        recordings = [Recording(regressor, self._measured(regressor, arguments.motion), times <= times[0] + until)]
        if arguments.unloaded:
            scene = without_payload(self.fit_scene)
            other = self._regressor('unloaded', scene, [arguments.unloaded], self._asked())
            recordings.append(Recording(other, self._measured(other, [arguments.unloaded], True),
                                        np.ones(len(other.times), dtype=bool), loaded=False))
        return recordings

    # --- the problem

    def _parameters(self, regressor):
        result = []
        for index, (kind, of, value) in enumerate(regressor.parameters):
            if kind in self.wanted.terms:
                result.append(Parameter(kind, of, value, index))
        for coupling in self.wanted.coupled(regressor.coordinates):
            for i, kind in enumerate(('coupled_damping', 'coupled_coulomb')):
                result.append(Parameter(
                    kind, coupling.name, 0.0, lambda regressor, coupling=coupling, i=i: coupling.columns(
                        regressor, self.arguments.coulomb_velocity)[i], coupling.first))
        index = {(kind, of): i for i, (kind, of, _) in enumerate(regressor.parameters)}
        if self.wanted.payload:
            for kind in bodies.KINDS:
                result.append(Parameter('payload_' + kind, self.wanted.payload, 0.0,
                                        index[(kind, self.wanted.payload)]))
        if self.wanted.base:
            for link in regressor.bodies:
                for kind in bodies.KINDS:
                    value = regressor.parameters[index[(kind, link)]][2]
                    result.append(Parameter(kind, link, value, index[(kind, link)]))
        return result

    def _rests(self, parameters, recordings):
        """Terms of joints that do not move in what is fitted."""
        regressor = recordings[0].regressor
        still = []
        for i, name in enumerate(regressor.coordinates):
            if all(np.ptp(each.regressor.positions[each.keep, i]) < RESTS for each in recordings):
                still.append(name)
        if len(still) == len(regressor.coordinates):
            raise Refusal('%s: the robot rests: no joint moves by more than %g rad or m in the part that is fitted'
                          % (self.arguments.motion[0], RESTS))
        kinds = ('damping', 'coulomb', 'rotor_inertia')
        return {k: 'the joint rests' for k, parameter in enumerate(parameters)
                if parameter.of in still and parameter.kind in kinds}

    def _scales(self, parameters, recordings, efforts):
        """How large the deviation of a parameter may be before it counts as unknown."""
        regressor = recordings[0].regressor
        names = [regressor.efforts[i] for i in efforts]
        keep = recordings[0].keep
        sizes = np.sqrt(np.nanmean(recordings[0].measured[keep][:, efforts] ** 2, axis=0))
        if self.wanted.gain:  # measured ones are in units of their own
            sizes = np.sqrt(np.nanmean(regressor.described[keep][:, efforts] ** 2, axis=0))
        size_of = dict(zip(names, sizes))
        scales = []
        for parameter in parameters:
            scale = LARGE * max(size_of.get(parameter.joint, np.median(sizes)), 1e-9)
            if parameter.joint in regressor.coordinates:
                i = regressor.coordinates.index(parameter.joint)
                if 'damping' in parameter.kind:
                    scale /= max(1, np.abs(regressor.velocities[keep, i]).max())
                if parameter.kind == 'rotor_inertia':
                    scale /= max(1, np.abs(regressor.accelerations[keep, i]).max())
            scales.append(scale)
        return scales

    def _blocks(self, parameters, regressor, payload_guess=None):
        """Bodies among the parameters, with what is thought of them before."""
        blocks = []
        firsts = [k for k, parameter in enumerate(parameters) if parameter.kind in ('mass', 'payload_mass')]
        described = {k: np.array([p.described for p in parameters[k:k + 10]]) for k in firsts}
        masses = [described[k][0] for k in firsts if parameters[k].kind == 'mass']
        mean = max(np.mean(masses), 1e-3) if masses else 1.0
        size = self.description.size()
        for k in firsts:
            if parameters[k].kind == 'payload_mass':
                guess = payload_guess
                if guess is None:
                    guess = bodies.body(1.0, np.zeros(3), PAYLOAD_RADIUS ** 2)
                blocks.append(Block(k, described[k], guess, VAGUE if payload_guess is None else 1.0))
                continue
            sound = described[k][0] > 0.05 * mean and bodies.is_possible(described[k])
            before = bodies.nearest_possible(described[k], size / max(len(masses), 1), 0.05 * mean)
            blocks.append(Block(k, described[k], before, 1.0 if sound else 0.01))
        return blocks

    def _base(self, regressor, parameters):
        """Which sums of inertial parameters, and of rotors, any motion can tell."""
        inertial = [k for k, parameter in enumerate(parameters) if parameter.kind in bodies.KINDS]
        inertial += [k for k, parameter in enumerate(parameters) if parameter.kind == 'rotor_inertia']
        simple = not any(self.scene.get(key) for key in ('closures', 'joint_types', 'springs')) and \
            self.scene.get('root', 'fixed') == 'fixed'
        states = self._random_states(regressor) if simple else regressor
        columns = np.array([np.nan_to_num(np.asarray(states.columns[parameters[k].source])).ravel()
                            for k in inertial])
        return inertial, BaseParameters(columns)

    def _random_states(self, regressor):
        path = os.path.join(self.folder, 'random.csv')
        random = np.random.default_rng(1)
        names = regressor.coordinates
        header = ['time'] + [kind + '.' + name for kind in ('position', 'velocity', 'acceleration') for name in names]
        ranges = [np.pi if regressor.units[name] == 'rad' else 1 for name in names]
        rows = np.hstack([np.arange(RANDOM_STATES)[:, None]] + [
            random.uniform(-1, 1, (RANDOM_STATES, len(names))) * scale for scale in (ranges, 3, 10)])
        np.savetxt(path, rows, delimiter=',', header=','.join(header), comments='', fmt='%.17g')
        return self._regressor('random', self.fit_scene, [path], self._asked(), recorded=False)

    # --- the solution

    def _outcome(self):
        recordings = self._recordings()
        regressor = recordings[0].regressor
        parameters = self._parameters(regressor)
        if not parameters and not self.wanted.gain:
            raise Refusal('--fit: there is nothing to fit')
        rests = self._rests(parameters, recordings)
        efforts = [i for i in range(len(regressor.efforts))
                   if all(np.isfinite(each.measured[each.keep, i]).any() for each in recordings)]
        if not efforts:
            raise Refusal('no effort is measured in the part of the recording that is fitted')
        keep = recordings[0].keep
        cutoff = self.arguments.cutoff
        if cutoff is not None and not cutoff > 0:
            raise Refusal('--cutoff: is not a positive number')
        if cutoff is None:
            if keep.sum() < 5:
                raise Refusal('the recording is too short to fit: %d rows' % keep.sum())
            cutoff = chosen_cutoff(regressor.times[keep], regressor.velocities[keep])
        pieces = []
        for each in recordings:
            pieces += filtered_pieces(each.regressor, each.measured, each.keep, efforts, parameters, cutoff,
                                      each.loaded, self.progress.named('filtering'))
        check_length(pieces, parameters, efforts, cutoff)
        outcome = Outcome(self.arguments, regressor, parameters, efforts, cutoff)
        outcome.recording = recordings[0]
        outcome.span = sum(piece.times[-1] - piece.times[0] for piece in pieces)
        self.progress.stage('fitting')
        self._solve(outcome, pieces, recordings, rests)
        return outcome

    def _solve(self, outcome, pieces, recordings, rests):
        """Fits; efforts whose gains turn out not to be told are left out, and the rest is fitted again."""
        parameters, efforts = outcome.parameters, outcome.efforts
        scales = self._scales(parameters, recordings, efforts)
        gains = range(len(efforts)) if self.wanted.gain else ()

        def solver(guess):
            return Solver(parameters, pieces, scales, self._blocks(parameters, outcome.regressor, guess), gains,
                          rests)

        its = solver(None)
        outcome.solution = its.solve()
        if self.wanted.gain and outcome.leave_out_unknown_gains(pieces):
            return self._solve(outcome, pieces, recordings, rests)
        if self.wanted.payload:
            # Once mass and centre are known, a ball of that mass is what is thought of the rest.
            first = next(k for k, parameter in enumerate(parameters) if parameter.kind == 'payload_mass')
            found = outcome.solution.x[first:first + 10]
            guess = bodies.body(found[0], found[1:4] / found[0], found[0] * PAYLOAD_RADIUS ** 2)
            its = solver(guess)
            outcome.solution = its.solve()
        outcome.blocks = its.blocks
        outcome.residual_pieces = its.residuals(outcome.solution.x, outcome.solution.gains)
        outcome.pieces = pieces
        told = [k for k in range(len(parameters)) if not its.inertial[k] and k not in outcome.solution.held]
        if self.wanted.base:
            outcome.inertial, outcome.base = self._base(outcome.regressor, parameters)
            kept = [outcome.inertial[row] for row in outcome.base.kept]
            told = sorted(set(told) - set(outcome.inertial) | set(kept))
        if self.wanted.payload:
            told += [k for k in range(len(parameters)) if parameters[k].kind.startswith('payload_')]
        told += range(len(parameters), len(outcome.solution.normal))
        outcome.condition = condition_of(outcome.solution.normal, told)

    # --- writing and judging

    def _write(self, outcome):
        folder = self.arguments.output
        payload = None
        if self.wanted.payload:
            payload = payload_entry(self.wanted.payload, outcome.body('payload_mass', self.wanted.payload))
        scene = found_scene(self.fit_scene, outcome.terms(), payload)
        outcome.scene = scene
        write_scene(os.path.join(folder, 'scene.yaml'), scene, outcome.scene_comments())
        outcome.urdf = self.arguments.urdf
        if self.wanted.base:
            found = {link: outcome.body('mass', link) for link in outcome.regressor.bodies}
            outcome.urdf = os.path.join(folder, 'robot.urdf')
            self.description.with_bodies(found, outcome.urdf)

    def _judge(self, outcome):
        """Efforts by the files that were written, beside the measured ones."""
        scene = dict(outcome.scene)
        recording = outcome.recording
        after = self._regressor('after', scene, self.arguments.motion, ['joints'], outcome.urdf)
        outcome.add_judged('fitted', recording, after, recording.keep)
        outcome.shown = (recording.regressor, recording.measured, after, recording.keep)
        if self.arguments.validation:
            motion = [self.arguments.validation]
            before = self._regressor('validation', self.fit_scene, motion, ['joints'])
            measured = self._measured(before, motion, True)
            everything = np.ones(len(before.times), dtype=bool)
            after = self._regressor('validation_after', scene, motion, ['joints'], outcome.urdf)
            outcome.add_judged('not fitted', Recording(before, measured, everything), after, everything)
            outcome.shown = (before, measured, after, ~everything)
        elif not recording.keep.all():
            outcome.add_judged('not fitted', recording, after, ~recording.keep)
