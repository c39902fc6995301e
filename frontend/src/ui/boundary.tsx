import { Component } from 'react';

import { Button } from './button';
import { Empty } from './panel';

interface Props {
  children: React.ReactNode;
  /** What it says when it caught something. */
  message: string;
  again: string;
}

/** Keeps a failure of one part from taking the page, and the stop button, with it. */
export class Boundary extends Component<Props, { failed: boolean }> {
  override state = { failed: false };

  static getDerivedStateFromError() {
    return { failed: true };
  }

  override render() {
    if (!this.state.failed) return this.props.children;
    return (
      <div role="alert">
        <Empty title={this.props.message}>
          <Button onPress={() => this.setState({ failed: false })}>{this.props.again}</Button>
        </Empty>
      </div>
    );
  }
}
