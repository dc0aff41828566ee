"""What a bag says about a run of inverse_dynamics_node: was anything lost on the way?"""
import struct

import rosbag

INPUT = '/joint_states'
COPY = '/copy/copy'
NODE = '/inverse_dynamics/'
DIAGNOSTICS = '/diagnostics'
# seq and stamp (s, ns) begin every message with a header.
HEADER = struct.Struct('<III')
STAMP_TOLERANCE = 1  # ns: the steps of most rates are no whole number of them


class Topic:
    """Headers of one topic in the order of recording."""

    def __init__(self):
        self.seqs = []
        self.stamps = []  # ns
        self.last_record = 0  # ns

    def add(self, data, record_time):
        seq, seconds, nanoseconds = HEADER.unpack_from(data)
        self.seqs.append(seq)
        self.stamps.append(seconds * 1000000000 + nanoseconds)
        self.last_record = record_time.to_nsec()

    def gaps(self):
        """How many numbers header.seq leaves out, or goes back by, from 0 on."""
        return sum(abs(b - a - 1) for a, b in zip([-1] + self.seqs, self.seqs))

    def wrong_stamps(self, first, rate):
        """How many stamps are not `first` (ns) plus seq steps of `rate`."""
        return sum(abs(stamp - first - seq * 1e9 / rate) > STAMP_TOLERANCE
                   for seq, stamp in zip(self.seqs, self.stamps))


class RecordedRun:
    """A bag's headers by topic, and the reports on /diagnostics by node."""

    def __init__(self, path, topics, progress):
        self.topics = {name: Topic() for name in topics}
        self._reports = {}
        with rosbag.Bag(str(path)) as bag:
            self.size_mb = bag.size / 1e6
            total = bag.get_message_count()
            for index, (name, message, time) in enumerate(bag.read_messages(raw=True)):
                if index % 10000 == 0:
                    progress('reading the bag: %d of %d messages' % (index, total))
                if name == DIAGNOSTICS:
                    self._add_report(message)
                elif name in self.topics:
                    self.topics[name].add(message[1], time)

    def _add_report(self, raw):
        report = raw[4]()
        report.deserialize(raw[1])
        for status in report.status:
            node = status.name.partition(':')[0]
            values = {entry.key: entry.value for entry in status.values}
            self._reports.setdefault(node, []).append(values)

    def count(self, node, key):
        """Last value of a counter of a node; 0 when the node never reported."""
        reports = self._reports.get(node)
        return int(reports[-1][key]) if reports else 0

    def times(self, node, key):
        """A run time in us, one for each report that has it."""
        return [float(report[key]) for report in self._reports.get(node, []) if key in report]

    def first_stamp(self, rate):
        """Stamp of the first joint state, ns, even if that is not in the bag."""
        joint_states = self.topics[INPUT]
        if not joint_states.stamps:
            return 0
        return joint_states.stamps[0] - round(joint_states.seqs[0] * 1e9 / rate)

    def last_record(self):
        """When the last message of all topics was recorded, ns."""
        return max(topic.last_record for topic in self.topics.values())
