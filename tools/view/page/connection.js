// A client of Foxglove's WebSocket protocol, version 1, which reconnects when the connection is lost.
import { decoder, seenPoints, transforms } from "./messages.js";

const AGAIN_MS = 1000;
const OF_ROS = { "tf2_msgs/msg/TFMessage": transforms, "sensor_msgs/msg/PointCloud2": seenPoints };

export class Connection {
  // `topics` are subscribed to. Callbacks: message(topic, value, timeNs), time(ns), status(id, level, text),
  // parameters({name: value}), open(), closed().
  constructor(url, topics, on) {
    this.url = url;
    this.topics = topics;
    this.on = on;
    this.connect();
  }

  connect() {
    this.subscriptions = [];
    this.waiting = undefined;
    this.socket = new WebSocket(this.url, ["foxglove.websocket.v1"]);
    this.socket.binaryType = "arraybuffer";
    this.socket.onmessage = ({ data }) => (typeof data === "string" ? this.text(JSON.parse(data)) : this.binary(new DataView(data)));
    this.socket.onclose = () => {
      this.on.closed();
      setTimeout(() => this.connect(), AGAIN_MS);
    };
  }

  send(message) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }
  set(name, value) {
    this.send({ op: "setParameters", parameters: [{ name, value }] });
  }

  text(message) {
    switch (message.op) {
      case "advertise":
        this.subscribe(message.channels);
        break;
      case "status":
        this.on.status(message.id, message.level, message.message);
        break;
      case "removeStatus":
        for (const id of message.statusIds) this.on.status(id, 0, "");
        break;
      case "parameterValues":
        this.on.parameters(Object.fromEntries(message.parameters.map(({ name, value }) => [name, value])));
        break;
    }
  }

  subscribe(channels) {
    for (const channel of channels.filter(({ topic }) => this.topics.includes(topic))) {
      const decode = channel.schemaEncoding === "omgidl" ? decoder(channel.schema, channel.schemaName) : OF_ROS[channel.schemaName];
      this.subscriptions.push({ topic: channel.topic, channelId: channel.id, decode });
    }
    this.send({ op: "subscribe", subscriptions: this.subscriptions.map(({ channelId }, id) => ({ id, channelId })) });
    this.send({ op: "subscribeParameterUpdates", parameterNames: [] });
    this.send({ op: "getParameters", parameterNames: [], id: "all" });
    this.on.open();
  }

  binary(view) {
    const ns = (at) => view.getUint32(at + 4, true) * 2 ** 32 + view.getUint32(at, true);
    if (view.getUint8(0) === 2) return this.on.time(ns(1));
    const subscription = this.subscriptions[view.getUint32(1, true)];
    if (!subscription) return;
    const message = { subscription, bytes: new DataView(view.buffer, 13), ns: ns(5) };
    if (subscription.decode === transforms) this.waiting = message;
    else this.hand(message);
  }
  hand({ subscription, bytes, ns }) {
    this.on.message(subscription.topic, subscription.decode(bytes), ns);
  }

  // A large cell has many poses: only the newest are decoded, when a frame needs them.
  handWaiting() {
    if (this.waiting) this.hand(this.waiting);
    this.waiting = undefined;
  }
}
